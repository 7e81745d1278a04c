"""Random devices over random lines: what a scan must be whatever it is made of.

python -m random_scans COUNT SEED            the worst of so many, from that seed on
python -m random_scans COUNT SEED sundials   the same against SUNDIALS, of those it can follow
python -m random_scans COUNT SEED [sundials] curved   with a friction curve at the plate
python -m random_scans COUNT SEED [sundials] oblique  with the drive at an angle to the hand
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from math import inf, radians
from typing import Any

import numpy as np

from pindrive import Contact, Drive
from pindrive.device import (
    Coil,
    ControlBlock,
    Device,
    Electromagnet,
    HandPath,
    PinScan,
    Scene,
    scan,
    strokes,
)


def sampled(path: HandPath, rows: int = 65) -> HandPath:
    """The path with a velocity that is linear between `rows` times in each stretch."""
    times = np.concatenate(
        [
            np.linspace(begin, end, rows if bend.any() else 2)[:-1]
            for begin, end, bend in zip(
                path.times[:-1], path.times[1:], path.bend_x + path.bend_y, strict=True
            )
        ]
        + [path.times[-1:]]
    )
    return HandPath(times, *path.velocity(times), (float(path.x[0]), float(path.y[0])))


def mirrored(path: HandPath) -> HandPath:
    """The path reflected in the y axis."""
    start = -float(path.x[0]), float(path.y[0])
    return HandPath(path.times, -path.vx, path.vy, start, bend_x=-path.bend_x, bend_y=path.bend_y)


def later(path: HandPath, by: float) -> HandPath:
    """The path on a clock that is ahead by a time, s."""
    start = float(path.x[0]), float(path.y[0])
    return HandPath(
        path.times + by, path.vx, path.vy, start, bend_x=path.bend_x, bend_y=path.bend_y
    )


@dataclass(frozen=True)
class RandomScan:
    """A device, a scene and a path drawn from a seed, over decades of every number."""

    device: Device
    scene: Scene
    path: HandPath
    cut: float
    """A time within the path, s."""

    @classmethod
    def of(cls, seed: int, *, curved: bool = False, oblique: bool = False) -> RandomScan:
        if oblique:
            return cls.of(seed, curved=curved).turned(seed)
        draw = np.random.default_rng(seed)

        def between(low: float, high: float) -> float:
            return float(np.exp(draw.uniform(np.log(low), np.log(high))))

        def either(*values: float) -> float:
            return float(draw.choice(values))

        plate, finger = between(0.002, 0.1), between(0.0005, 0.05)
        rows = np.random.default_rng([seed, 1])  # so that all else is as without a curve
        speeds = np.cumsum([0.0, *np.exp(rows.uniform(np.log(0.002), np.log(0.2), 2))])
        forces = plate * np.array([1.0, *rows.uniform(0.3, 1.5, 2)])
        curve = list(zip(speeds.tolist(), forces.tolist(), strict=True)) if curved else None
        drive = Drive(
            mass=between(0.002, 0.05),
            stiffness=between(20.0, 1000.0),
            damping_ratio=either(0.0, between(0.01, 2.0)),
            plate=Contact(plate, plate * either(1.0, 1.2, 1.8), curve=curve),
            finger=Contact(
                finger, finger * either(1.0, 1.5), stiffness=either(inf, between(50.0, 3000.0))
            ),
        )
        magnet = Electromagnet(
            hold_force=between(0.1, 20.0),
            rise_constant=between(1e-4, 1e-2),
            fall_constant=between(1e-4, 1e-2),
            saturation=either(1.0, draw.uniform(0.1, 1.0)),
            residual=either(0.0, 0.02),
        )
        control = ControlBlock(
            sample_rate=between(100.0, 5000.0), latency=either(0.0, between(1e-3, 0.05))
        )
        pitches = [between(0.0006, 0.01) for _ in range(draw.integers(1, 4))]
        lines = Scene.from_grating(
            pitches, count=int(draw.integers(1, 4)), margin=0.004, pixel=2e-4, height=0.002
        )
        half = 0.5 * lines.luminance.shape[1] * lines.pixel
        scene = Scene(lines.luminance, lines.pixel, (-half, 0.0), lines.lines)
        y = scene.lines[0]
        stops = [(0.001 - half, y), (half - 0.001, y)]
        if draw.random() < 0.4:
            stops.append(stops[0])  # and back
        path = strokes(stops, between(0.01, 0.4), pause=either(0.0, 0.05))
        cut = float(draw.uniform(0.05, 0.95)) * path.end
        return cls(Device(drive=drive, magnet=magnet, control=control), scene, path, cut)

    def turned(self, seed: int) -> RandomScan:
        """The drive at 1° to 80° to the hand, which moves from beginning to end of its one stroke.

        A general integrator cannot start where both the plate's velocities are 0.
        """
        draw = np.random.default_rng([seed, 2])
        angle = radians(float(np.exp(draw.uniform(0.0, np.log(80.0)))))
        device = replace(self.device, array=replace(self.device.array, axis=angle))
        halts = self.path.times[self.path.vx == 0.0][1]
        stroke = self.path.between(0.01 * halts, 0.99 * halts)
        x, y = (float(place) for place in self.path.position(stroke.begin))
        path = HandPath(
            stroke.times - stroke.begin,
            stroke.vx,
            stroke.vy,
            (x, y),
            bend_x=stroke.bend_x,
            bend_y=stroke.bend_y,
        )
        return replace(self, device=device, path=path, cut=self.cut * path.end / self.path.end)

    def linear(self) -> RandomScan:
        """Scan with a sampled path, for the oracles."""
        return replace(self, path=sampled(self.path))

    def scan(self) -> PinScan:
        return scan(self.device, self.scene, self.path, threads=1).pins[0]

    def halves(self) -> tuple[PinScan, PinScan]:
        parts = self.path.between(0.0, self.cut), self.path.between(self.cut, self.path.end)
        first = scan(self.device, self.scene, parts[0], threads=1)
        second = scan(self.device, self.scene, parts[1], start=first.state, threads=1)
        return first.pins[0], second.pins[0]

    def mirrored(self) -> PinScan:
        path, scene = self.path, self.scene
        back = mirrored(path)
        other = replace(scene, luminance=scene.luminance[:, ::-1])
        array = replace(self.device.array, axis=-self.device.array.axis)
        return scan(replace(self.device, array=array), other, back, threads=1).pins[0]


def random_magnet(rng: np.random.Generator, *, warms: bool = False) -> Electromagnet | None:
    """By times or by a coil, with pulses, voltage steps and a gap that opens; None: impossible."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    given: dict[str, Any] = {"residual": float(rng.choice([0.0, 0.005]))}
    if rng.random() < 0.5:
        given |= {"pwm_frequency": between(100.0, 3000.0), "pwm_duty": rng.uniform(0.1, 0.9)}
    if rng.random() < 0.3:
        return Electromagnet(
            hold_force=between(0.1, 20.0),
            rise_constant=between(1e-4, 1e-2),
            fall_constant=between(1e-4, 1e-2),
            saturation=float(rng.choice([1.0, rng.uniform(0.1, 1.0)])),
            **given,
        )
    opens = rng.random() < 0.5
    coil = Coil(
        turns=250,
        pole_area=between(1e-6, 5e-6),
        gap=between(2e-5, 2e-4),
        wire_diameter=between(4e-5, 2e-4),
        turn_length=0.0088,
        supply_voltage=between(0.5, 10.0),
        release_resistance=float(rng.choice([0.0, between(1.0, 100.0)])),
        heat_capacity=between(0.01, 1.0) if warms else None,
        lift=between(1e-5, 1e-4) if opens else None,
        closing_force=0.02 if opens else None,
    )
    volts = coil.supply_voltage
    steps = [(0.0, volts), (0.003, 0.5 * volts), (0.02, 0.7 * volts)]
    voltage = None if "pwm_duty" in given or rng.random() < 0.5 else steps
    try:
        return Electromagnet.from_coil(coil, voltage=voltage, **given)
    except ValueError:  # the gap would never close, or never open
        return None


def short(pin: PinScan) -> bool:
    """Return True if a general integrator finishes within a second."""
    pieces = 1 if isinstance(pin.load, float) else len(pin.load.pieces)
    return pieces <= 60 and pin.end <= 4.0


def parting(whole: PinScan, halves: tuple[PinScan, PinScan]) -> float:
    """Return the difference of two halves from the whole, relative to its largest deflection."""
    largest = np.abs(whole.position(np.linspace(whole.begin, whole.end, 2000))).max()
    worst = 0.0
    for half in halves:
        t = np.linspace(half.begin, half.end, 400)
        worst = max(worst, float(np.abs(half.position(t) - whole.position(t)).max()))
    return worst / max(float(largest), 1e-9)


def mirrors(pin: PinScan, other: PinScan) -> bool:
    """Return True if two scans are mirror images, to the bit."""
    t = np.linspace(pin.begin, pin.end, 500)
    return (
        np.array_equal(pin.commands.times, other.commands.times)
        and np.array_equal(pin.position(t), -other.position(t))
        and [e.time for e in pin.events] == [e.time for e in other.events]
    )


def main(count: int, seed: int, *, curved: bool, oblique: bool) -> None:
    residual = part = 0.0
    events = turned = 0
    for one in (
        RandomScan.of(s, curved=curved, oblique=oblique) for s in range(seed, seed + count)
    ):
        pin = one.scan()
        residual = max(residual, pin.motion.certificate().worst)
        part = max(part, parting(pin, one.halves()))
        turned += mirrors(pin, one.mirrored())
        events += len(pin.events)
    print(f"{count} scans from seed {seed}, {events} events: largest residual {residual:.1e},")
    print(f"in two halves {part:.1e} apart, {turned} mirrored to the bit")


def main_sundials(count: int, seed: int, *, curved: bool, oblique: bool) -> None:
    """SciPy's DOP853 runs with equal modes if SUNDIALS steps over two zeros."""
    from oracle.scan_cycles import Distance, distance
    from oracle.watched_dop853 import dop853

    drawn = (
        RandomScan.of(s, curved=curved, oblique=oblique).linear().scan()
        for s in range(seed, seed + count)
    )
    pins = [pin for pin in drawn if short(pin)]
    found: list[Distance] = []
    others: list[Distance] = []
    for pin in pins:
        first = distance(pin)
        apart = not first.events or first.time > 1e-6
        (others if apart else found).append(distance(pin, dop853) if apart else first)
    print(f"{len(pins)} scans, {sum(len(pin.events) for pin in pins)} events:")
    for tool, distances in (("SUNDIALS", found), ("DOP853, as SUNDIALS steps over events", others)):
        if distances:
            print(
                f"{sum(d.events for d in distances)} of {len(distances)} with the same events by "
                f"{tool}, times within {max(d.time for d in distances):.1e} s, positions within "
                f"{max(d.position for d in distances):.1e} of the largest, all states within "
                f"{max(d.state for d in distances):.1e}"
            )


if __name__ == "__main__":
    run = main_sundials if "sundials" in sys.argv else main
    run(
        int(sys.argv[1]),
        int(sys.argv[2]),
        curved="curved" in sys.argv,
        oblique="oblique" in sys.argv,
    )
