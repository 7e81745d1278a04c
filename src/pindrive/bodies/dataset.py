"""A motion of several bodies as an xarray Dataset, and as columns for a table."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive.bodies.system_motion import SystemMotion
from pindrive.lazy import xr
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.quantities.bodies import OF_BODY, OF_CONTACT, OF_FEEDBACK, OF_SPRING, OF_STOP
from pindrive.quantities.quantity import heading
from pindrive.quantities.status import outcome_attributes


def columns(motion: SystemMotion, t: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return everything at times, SI, by heading: "body.pin.position [m]"; right-hand limits.

    Args:
        motion: A motion.
        t: s, shape (n,).
    """
    found = {heading("time", "s"): t}
    moving, touching, pushing, controlling = motion.state_at(t)
    for i, name in enumerate(motion.system.bodies):
        for quantity, values in zip(OF_BODY, moving[:, i], strict=True):
            found[heading(f"body.{name}.{quantity.name}", quantity.unit)] = values
    for i, name in enumerate(motion.system.contacts):
        for quantity, values in zip(OF_CONTACT, touching[:, i], strict=True):
            found[heading(f"contact.{name}.{quantity.name}", quantity.unit)] = values
    for name, force in zip(motion.system.stops, pushing, strict=True):
        found[heading(f"stop.{name}.force", "N")] = force
    for name, force in zip(motion.system.feedbacks, controlling, strict=True):
        found[heading(f"feedback.{name}.force", "N")] = force
    for name in motion.system.springs:
        pull = motion.spring(name)
        for quantity, values in zip(OF_SPRING, (pull.force(t), pull.elongation(t)), strict=True):
            found[heading(f"spring.{name}.{quantity.name}", quantity.unit)] = np.asarray(values)
    return found


def dataset(motion: SystemMotion, t: NDArray[np.float64]) -> xr.Dataset:
    """Return bodies, contacts and springs at times (s, shape (n,)), events, numbers and inputs."""
    from pindrive import __version__

    system = motion.system
    moving, touching, pushing, controlling = motion.state_at(t)
    data: dict[str, Any] = {
        q.name: (("body", "time"), values, q.attributes)
        for q, values in zip(OF_BODY, moving, strict=True)
    }
    for quantity, values in zip(OF_CONTACT, touching, strict=True):
        data[f"contact_{quantity.name}"] = (("contact", "time"), values, quantity.attributes)
    pulls = [motion.spring(name) for name in system.springs]
    for quantity in OF_SPRING:
        rows = [getattr(pull, quantity.name)(t) for pull in pulls]
        values = np.array(rows).reshape(len(pulls), len(t))
        data[f"spring_{quantity.name}"] = (("spring", "time"), values, quantity.attributes)
    if system.stops:
        data["stop_force"] = (("stop", "time"), pushing, OF_STOP[0].attributes)
    if system.feedbacks:
        of = OF_FEEDBACK[0].attributes
        data["feedback_force"] = (("feedback", "time"), controlling, of)
    events = motion.events
    data["event_time"] = ("event", np.array([e.time for e in events]), {"units": "s"})
    for name in ("contact", "kind"):
        data[f"event_{name}"] = ("event", np.array([getattr(e, name) for e in events], dtype=str))
    data["status"] = ((), np.int8(motion.status), outcome_attributes("status"))
    coords = {
        "time": ("time", t, {"units": "s", "long_name": "time"}),
        "body": [*system.bodies],
        "contact": [*system.contacts],
        "spring": [*system.springs],
        **({"stop": [*system.stops]} if system.stops else {}),
        **({"feedback": [*system.feedbacks]} if system.feedbacks else {}),
    }
    attributes = {
        "title": "Motion of a system of bodies",
        "source": f"pindrive {__version__}",
        **{key: _plain(value) for key, value in system.inputs().items()},
        **motion.numbers(),
    }
    return xr.Dataset(data, coords=coords, attrs=attributes)


def _plain(value: Any) -> Any:
    """Return a value as an attribute has it: a number, or the text of rows or of a function."""
    if isinstance(value, Profile):
        return str(value.rows)
    return repr(value) if isinstance(value, Function) else value
