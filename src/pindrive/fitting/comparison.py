"""Comparison of friction laws on equal recordings, by Akaike's criterion."""

from __future__ import annotations

from math import inf
from typing import Any, Final

import numpy as np

from pindrive.fitting.estimation import fit
from pindrive.fitting.results import Fit, ModelComparison
from pindrive.motion.drive import Contact, Drive, Stribeck
from pindrive.motion.profile import Profile

__all__ = ["compare_models"]

SPEEDS: Final = (0.0, 0.1, 0.4, 1.0)
"""Rows of a friction curve that is tried, in parts of the largest sliding speed."""
STRIBECK: Final = 0.2
"""Stribeck velocity from which a fit starts, a part of the largest sliding speed."""
LAWS: Final = ("Coulomb", "static friction", "Stribeck", "friction curve", "compliant skin")
"""In their order."""


def compare_models(found: Fit, seed: int = 1) -> ModelComparison:
    """Fits of other laws of friction to the recordings of a fit, by AICc.

    Args:
        found: The fit; what it had free besides friction is free again.
        seed: Seed of the candidates.

    Returns:
        Coulomb friction, static friction, Stribeck's law, a friction curve and compliant skin, each
        where the drive can have it, with AICc and weights.

    Raises:
        ValueError: None of them can be fitted.
    """
    model = found.model
    bounds = {p.key: (p.lower, p.upper) for p in model.parameters}
    others = [p.key for p in model.parameters if not _of_friction(p.key) and not p.of_noise]
    friction = [p.key for p in model.parameters if p.key.endswith(".kinetic")]
    contacts = [
        name
        for name in ("plate", "finger")
        if f"{name}.kinetic" in friction or not getattr(found.drive, name).frictionless
    ]
    fits, refused = {}, {}
    for law in LAWS:
        drive, keys = _changed(law, found, contacts, friction)
        if drive is None:
            refused[law] = keys[0]
            continue
        free = [*dict.fromkeys([*others, *keys])]
        kept = {key: ends for key, ends in bounds.items() if key in free}
        try:
            fits[law] = fit(
                found.given,
                drive,
                found.releases,
                free=free,
                bounds=kept,
                seed=seed,
                confidence=found.confidence,
                profiles=False,
                own=model.own,
            )
        except ValueError as error:
            refused[law] = str(error)
    if not fits:
        raise ValueError("; ".join(f"{law}: {why}" for law, why in refused.items()))
    return ModelComparison(fits, refused)


def _of_friction(key: str) -> bool:
    return key.startswith(("plate.", "plate_curve", "finger.", "finger_curve"))


def _changed(
    law: str, found: Fit, contacts: list[str], friction: list[str]
) -> tuple[Drive | None, list[str]]:
    """Return a drive of another law with its free parameters; None, and the reason, else."""
    drive = found.drive
    made: dict[str, Any] = {
        name: Contact(getattr(drive, name).kinetic) for name in ("plate", "finger")
    }
    keys = friction or [f"{name}.kinetic" for name in contacts]
    match law:
        case "static friction":
            keys = [*keys, *(f"{name}.static" for name in contacts)]
            for name in contacts:
                kinetic = made[name].kinetic
                made[name] = Contact(kinetic, 1.2 * kinetic)
        case "Stribeck":
            rigid = [name for name in contacts if name == "plate" or drive.finger.rigid]
            for name in rigid:
                kinetic = made[name].kinetic
                made[name] = Stribeck(
                    kinetic=kinetic,
                    breakaway=1.2 * kinetic,
                    stribeck_velocity=STRIBECK * _fastest(found),
                )
                keys = [*keys, f"{name}.breakaway", f"{name}.stribeck_velocity"]
            if not rigid:
                return None, ["skin that stretches has no law by which friction falls"]
        case "friction curve":
            loaded = any(
                isinstance(release.plate_load, Profile) and release.plate_load.changes
                for release in found.releases
            )
            curved = [name for name in contacts if not (name == "plate" and loaded)]
            if not curved:
                return None, ["a plate whose load changes has no friction curve"]
            speeds = np.array(SPEEDS) * _fastest(found)
            for name in curved:
                kinetic = made[name].kinetic
                made[name] = Contact(curve=[(float(u), kinetic) for u in speeds])
                keys = [key for key in keys if key != f"{name}.kinetic"]
                keys += [f"{name}_curve[{i}].force" for i in range(len(speeds))]
        case "compliant skin":
            if "finger" not in contacts:
                return None, ["the finger has no friction"]
            skin = drive.finger.stiffness
            kinetic = made["finger"].kinetic
            made["finger"] = Contact(
                kinetic, stiffness=10.0 * drive.stiffness if skin == inf else skin
            )
            keys = [*keys, "finger.stiffness"]
    return (
        Drive(mass=drive.mass, stiffness=drive.stiffness, damping=drive.damping, **made),
        keys,
    )


def _fastest(found: Fit) -> float:
    """The largest speed at which the fitted pin slides, m/s."""
    speeds = []
    for motion in found.motions:
        times = motion.sample_times()
        v = motion.velocity(times)
        speeds += [np.abs(v).max(), np.abs(v - motion.plate_velocity(times)).max()]
    return float(max(speeds))
