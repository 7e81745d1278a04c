"""Random drives and releases for the property tests, in every damping regime."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from hypothesis import strategies as st

from pindrive import Contact, Drive, Motion, simulate


@dataclass(frozen=True)
class Release:
    """A drive and how it is released: everything that `simulate` is given, SI."""

    drive: Drive
    mouse_velocity: float
    displacement: float
    velocity: float | None = None

    def run(self, duration: float | None = None) -> Motion:
        return simulate(
            self.drive,
            mouse_velocity=self.mouse_velocity,
            displacement=self.displacement,
            velocity=self.velocity,
            duration=duration,
        )

    def rescaled(self, time: float, length: float, mass: float) -> Release:
        """The same drive in other units of time, length and mass."""
        force, speed = mass * length / time**2, length / time
        drive = self.drive

        def contact(c: Contact) -> Contact:
            return Contact(c.kinetic * force, c.static_friction * force)

        return Release(
            Drive(
                mass=drive.mass * mass,
                stiffness=drive.stiffness * mass / time**2,
                damping=drive.damping * mass / time,
                plate=contact(drive.plate),
                finger=contact(drive.finger),
            ),
            self.mouse_velocity * speed,
            self.displacement * length,
            None if self.velocity is None else self.velocity * speed,
        )

    def mirrored(self) -> Release:
        return replace(
            self,
            mouse_velocity=-self.mouse_velocity,
            displacement=-self.displacement,
            velocity=None if self.velocity is None else -self.velocity,
        )


def decades(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


friction = st.one_of(st.just(0.0), decades(1e-3, 0.1))
damping_ratio = st.one_of(
    st.just(0.0),
    decades(1e-3, 0.9),
    st.sampled_from([1 - 1e-3, 1 - 1e-9, 1 - 1e-15, 1.0, 1 + 1e-15, 1 + 1e-9, 1 + 1e-3]),
    decades(1.0, 40.0),
)


@st.composite
def contacts(draw: st.DrawFn) -> Contact:
    kinetic = draw(friction)
    return Contact(kinetic, kinetic * draw(st.one_of(st.just(1.0), decades(1.0, 2.5))))


@st.composite
def releases(draw: st.DrawFn) -> Release:
    drive = Drive.with_damping_ratio(
        mass=draw(decades(2e-3, 2e-2)),
        stiffness=draw(decades(20.0, 400.0)),
        damping_ratio=draw(damping_ratio),
        plate=draw(contacts()),
        finger=draw(contacts()),
    )
    return Release(
        drive,
        draw(st.one_of(st.just(0.0), decades(0.02, 0.3), decades(-0.3, -0.02))),
        draw(st.one_of(st.just(0.0), decades(1e-9, 3e-3), decades(-3e-3, -1e-9))),
        draw(st.one_of(st.none(), st.just(0.0), decades(1e-9, 0.3), decades(-0.3, -1e-9))),
    )


def last_known(motion: Motion) -> float:
    """The last finite time at which the motion has an event, s; 0 without any."""
    return max((e.time for e in motion.events if e.time < inf), default=0.0)
