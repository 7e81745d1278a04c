"""Random drives and releases for the property tests, in every damping regime."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from hypothesis import strategies as st

from pindrive import Contact, Drive, Motion, Release, simulate


@dataclass(frozen=True)
class Case:
    """A drive and its release."""

    drive: Drive
    release: Release

    @property
    def mouse_velocity(self) -> float:
        """That of the release, which is constant, m/s."""
        assert isinstance(self.release.mouse_velocity, float)
        return self.release.mouse_velocity

    def run(self, duration: float | None = None) -> Motion:
        return simulate(self.drive, self.release, duration=duration)

    def rescaled(self, time: float, length: float, mass: float) -> Case:
        """Return the drive in other units of time, length and mass."""
        force, speed = mass * length / time**2, length / time
        drive, release = self.drive, self.release

        def contact(c: Contact) -> Contact:
            return Contact(c.kinetic * force, c.static_friction * force)

        return Case(
            Drive(
                mass=drive.mass * mass,
                stiffness=drive.stiffness * mass / time**2,
                damping=drive.damping * mass / time,
                plate=contact(drive.plate),
                finger=contact(drive.finger),
            ),
            Release(
                self.mouse_velocity * speed,
                release.displacement * length,
                None if release.velocity is None else release.velocity * speed,
            ),
        )

    def mirrored(self) -> Case:
        release = self.release
        velocity = None if release.velocity is None else -release.velocity
        return Case(self.drive, Release(-self.mouse_velocity, -release.displacement, velocity))


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
def cases(draw: st.DrawFn) -> Case:
    drive = Drive(
        mass=draw(decades(2e-3, 2e-2)),
        stiffness=draw(decades(20.0, 400.0)),
        damping_ratio=draw(damping_ratio),
        plate=draw(contacts()),
        finger=draw(contacts()),
    )
    release = Release(
        draw(st.one_of(st.just(0.0), decades(0.02, 0.3), decades(-0.3, -0.02))),
        draw(st.one_of(st.just(0.0), decades(1e-9, 3e-3), decades(-3e-3, -1e-9))),
        draw(st.one_of(st.none(), st.just(0.0), decades(1e-9, 0.3), decades(-0.3, -1e-9))),
    )
    return Case(drive, release)


def last_known(motion: Motion) -> float:
    """The last finite time at which the motion has an event, s; 0 without any."""
    return max((e.time for e in motion.events if e.time < inf), default=0.0)
