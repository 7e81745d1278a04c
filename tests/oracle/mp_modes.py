"""Modes without a closed form, followed to their first event in forty digits.

Each is solved by Taylor series of order 40 with steps far within their radius of convergence; what
ends it is found by `earliest_zero`. The skin's state is its force here, in every mode.
"""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mp, mpf

from oracle.mp_oracle import horner
from oracle.mp_series import Guard, Poly, by_line, earliest_zero, plus, times

ORDER = 40
SHORT = mpf("0.15")  # part of the radius of convergence, as the last terms show it


class DoubtError(Exception):
    """The answer is ill-conditioned."""


@dataclass(frozen=True)
class Case:
    """A mode at an instant: SI, decimal numbers as they are stored.

    A contact is its state and its branch (force, from, to, slope). States: -1 and 1 slip, 0 stick,
    2 absent, 3 elastic stick, 5 slip under an oblique hand. `skin` is the sliding velocity of a
    compliant finger that slips, or the force in one that sticks.
    """

    mass: float
    damping: float
    stiffness: float
    plate_velocity: tuple[float, float]
    load: tuple[float, float]
    across: tuple[float, float]
    plate: int
    plate_branch: tuple[float, float, float, float]
    plate_static: float
    finger: int
    finger_stiffness: float
    finger_branch: tuple[float, float, float, float]
    finger_static: float
    x: float
    v: float
    skin: float
    duration: float


@dataclass(frozen=True)
class Answer:
    """Ending guard (0: none within the duration), its time, and the state there."""

    guard: int
    time: mpf
    x: mpf
    v: mpf
    skin_force: mpf


@dataclass
class Series:
    """Series of the quantities of a mode over a time h: coefficients of t/h."""

    x: Poly
    v: Poly
    q: Poly
    slider: Poly
    speed: Poly
    stick: Poly
    radius: mpf  # of convergence, in units of h


def solve(case: Case) -> Answer:
    """Follow the mode until a guard falls to zero or the duration is over."""
    t, x, v = mpf(0), mpf(case.x), mpf(case.v)
    force, start, _, slope = map(mpf, case.finger_branch)
    slips = abs(case.finger) == 1
    s = case.finger if slips else 0
    skin = mpf(case.skin)
    q = s * (force - slope * start) + slope * skin if compliant(case) and slips else skin
    end = mpf(case.duration)
    h = end / 64
    first = True
    while True:
        h = min(h, end - t)
        series = expand(case, t, x, v, q, h)
        if series.radius < 1 / SHORT * mpf("0.98"):
            h *= SHORT * series.radius * mpf("0.99")
            continue
        found: list[tuple[mpf, int]] = []
        for number, guard in guards(case, series, t, h, first):
            s_zero = earliest_zero(guard, mpf(1), doubt)
            if s_zero < 1:
                found.append((s_zero, number))
        if found:
            found.sort()
            at, number = found[0]
            if len(found) > 1 and found[1][0] - at < mpf("1e-9"):
                raise DoubtError("two at once")
        else:
            at, number = mpf(1), 0
        state = [horner(p, at) for p in (series.x, series.v, series.q)]
        t += at * h
        if found or not t < end * (1 - mpf("1e-30")):
            return Answer(number, t, *state)
        x, v, q = state
        h *= SHORT * series.radius
        first = False


def doubt(why: str, _: mpf) -> None:
    raise DoubtError(why)


def compliant(case: Case) -> bool:
    return case.finger_stiffness > 0 and case.finger != 2


def line(given: tuple[float, float], t: mpf, h: mpf) -> Poly:
    return [mpf(given[0]) + mpf(given[1]) * t, mpf(given[1]) * h]


def product(p: Poly, q: Poly, n: int) -> mpf:
    """The coefficient n of a product."""
    return mp.fdot((p[i], q[n - i]) for i in range(n + 1) if i < len(p) and n - i < len(q))


def expand(case: Case, t: mpf, x0: mpf, v0: mpf, q0: mpf, h: mpf) -> Series:
    m, b, k = mpf(case.mass), mpf(case.damping), mpf(case.stiffness)
    v_p, load, w = (line(g, t, h) for g in (case.plate_velocity, case.load, case.across))
    force, begin, _, slope = map(mpf, case.plate_branch)
    of_finger, finger_begin, _, finger_slope = map(mpf, case.finger_branch)
    finger_side = case.finger if abs(case.finger) == 1 else 0
    soft = compliant(case)
    held = case.plate == 0 or case.finger == 0
    surface = v_p if case.plate == 0 else [mpf(0), mpf(0)]
    inertia = m * mpf(case.plate_velocity[1])

    x, v, q = [x0], [surface[0] if held else v0], [q0]
    u: Poly = []
    square: Poly = []
    root: Poly = []
    unit: Poly = []
    friction: Poly = []
    slider: Poly = []
    stick: Poly = []
    for n in range(ORDER):
        u.append(v[n] - (v_p[n] if n < 2 else 0))
        if case.plate == 5:
            square.append(product(u, u, n) + (product(w, w, n) if n < 3 else 0))
            if n == 0:
                root.append(mp.sqrt(square[0]))
            else:
                inner = mp.fdot((root[i], root[n - i]) for i in range(1, n))
                root.append((square[n] - inner) / (2 * root[0]))
            inner = mp.fdot((unit[i], root[n - i]) for i in range(n))
            unit.append((u[n] - inner) / root[0])
        else:
            unit.append(mpf(case.plate if n == 0 else 0))
            root.append(case.plate * u[n])
        sliding = abs(case.plate) == 1 or case.plate == 5
        friction.append((force - slope * begin) * unit[n] + slope * u[n] if sliding else mpf(0))
        of_plate = -product(load, friction, n)
        if soft:
            back = -q[n]
        else:
            constant = finger_side * (of_finger - finger_slope * finger_begin) if n == 0 else 0
            back = -(constant + (finger_slope * v[n] if finger_side else 0))
        known = of_plate + back - b * v[n] - k * x[n] + (inertia if n == 0 else 0)
        if held:
            rate = surface[1] if n == 0 else mpf(0)
            stick.append(m * rate / h - known if n == 0 else -known)
        else:
            rate = h * known / m / (n + 1)
        if soft and finger_side:
            constant = finger_side * (finger_begin - of_finger / finger_slope) if n == 0 else 0
            slider.append(constant + q[n] / finger_slope)
        else:
            slider.append(mpf(0))
        x.append(h * v[n] / (n + 1))
        v.append(rate)
        q.append(h * mpf(case.finger_stiffness if soft else 0) * (v[n] - slider[n]) / (n + 1))
    radius = mpf(1000)
    for p in (x, v, q, slider, root, unit):
        largest = max(abs(c) for c in p[:3])
        for n in (ORDER - 2, ORDER - 1):
            if abs(p[n]) > mpf("1e-60") * largest > 0:
                radius = min(radius, (largest / abs(p[n])) ** (mpf(1) / n))
    return Series(x, v, q, slider, root, stick, radius)


def guards(case: Case, s: Series, t: mpf, h: mpf, first: bool) -> list[tuple[int, Guard]]:
    """Return the guards of the mode: numbered, positive while it lasts."""
    found: list[tuple[int, Guard]] = []

    def add(number: int, poly: Poly, scale: mpf) -> None:
        if first and abs(poly[0]) < mpf("1e-14") * scale:  # it begins there, but for rounding
            poly = [mpf(0), *poly[1:]]
        guard = Guard("", "", poly, scale)
        if not guard.idle:
            found.append((number, guard))

    def between(number: int, poly: Poly, branch: tuple[float, float, float, float]) -> None:
        scale = abs(poly[0]) + abs(mpf(branch[1])) + abs(poly[1])
        add(number, plus(poly, [-mpf(branch[1])]), scale)
        if branch[2] < 1e300:
            add(number + 1, plus([mpf(branch[2])], times(mpf(-1), poly)), scale)

    if abs(case.plate) == 1 or (case.plate == 5 and case.plate_branch[3] != 0):
        between(1, s.speed, case.plate_branch)
    if abs(case.finger) == 1:
        sliding = s.slider if compliant(case) else s.v
        between(3, times(mpf(case.finger), sliding), case.finger_branch)
    if case.finger == 3:
        limit = mpf(case.finger_static)
        add(5, plus([limit], times(mpf(-1), s.q)), limit)
        add(6, plus([limit], s.q), limit)
    if case.plate == 0 or case.finger == 0:
        on_plate = case.plate == 0
        limits = (
            by_line(line(case.load, t, h), [mpf(case.plate_static)])
            if on_plate
            else [mpf(case.finger_static)]
        )
        scale = abs(limits[0]) + abs(s.stick[0])
        add(7, plus(limits, times(mpf(-1), s.stick)), scale)
        add(8, plus(limits, s.stick), scale)
    return found
