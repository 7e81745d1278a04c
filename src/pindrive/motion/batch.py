"""Many drives at once: arrays of parameters in, the numbers of each motion out as a Dataset."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import inf, nan
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.lazy import xr
from pindrive.motion.drive import Drive
from pindrive.motion.friction import (
    COEFFICIENT_OF,
    COEFFICIENTS,
    PRESSED_BY,
    PRESSING,
    friction_force,
)
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.motion.release import Release, check_fits
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.drive import OR_INFINITE
from pindrive.quantities.names import Names, number_names
from pindrive.quantities.quantity import POSITIVE_OR_RIGID, Bounds
from pindrive.quantities.refusal import refusal
from pindrive.quantities.results import ENDING, ENERGY, FINAL, TRANSIENT
from pindrive.quantities.status import OUTCOMES, outcome_attributes
from pindrive.quantities.table import QUANTITIES, check, warn_of

if TYPE_CHECKING:
    Broadcastable = ArrayLike | xr.DataArray

__all__ = ["simulate_batch"]

# The arguments in the order that the core takes them: the row of each in the table of quantities.
_ARGUMENTS: Final = {
    name.replace(".", "_"): QUANTITIES[name]
    for name in (
        "mass",
        "stiffness",
        "damping",
        "plate.kinetic",
        "plate.static",
        "finger.kinetic",
        "finger.static",
        "finger.stiffness",
        "mouse_velocity",
        "displacement",
        "velocity",
        "duration",
        "settling_band",
        "plate_load",
    )
}
_STOPS: Final = {name: QUANTITIES[name] for name in ("travel", "stop_stiffness", "stop_damping")}
_OTHERS: Final = _STOPS | {"finger_damping": QUANTITIES["finger.damping"]}
# Arguments in place of friction forces.
_FORCES: Final = [name for name in COEFFICIENT_OF if name.endswith(("kinetic", "static"))]
_TAKEN: Final = (
    _ARGUMENTS
    | _OTHERS
    | {
        name.replace(".", "_"): QUANTITIES[name]
        for name in ("damping_ratio", *(COEFFICIENT_OF[n] for n in _FORCES), *PRESSING)
    }
)
_ARGUMENT_NAMES: Final = Names(
    "argument",
    {name: (quantity.key,) for name, quantity in _TAKEN.items()},
    listed="docs/reference/python.md",
)
# Value of an omitted argument: another argument, infinite, or the default.
_SAME_AS: Final = {
    "plate_static": "plate_kinetic",
    "finger_static": "finger_kinetic",
    "velocity": "mouse_velocity",
}
_INFINITE: Final = ("finger_stiffness", "duration")
_LEFT_OUT: Final = {"settling_band": _core.settling_band, "plate_load": 1.0} | dict.fromkeys(
    _INFINITE, inf
)


def _interval(*sets: Bounds) -> tuple[float, float, float]:
    """The smallest and the largest value that all of the sets hold, and one beside them or NaN."""
    least = max(b.lower if b.lower_closed else float(np.nextafter(b.lower, inf)) for b in sets)
    most = min(b.upper if b.upper_closed else float(np.nextafter(b.upper, -inf)) for b in sets)
    beside = [
        value
        for b in sets
        if (value := b.also) is not None and all(value in other for other in sets)
    ]
    return least, most, beside[0] if beside else nan


# Checks of the arguments, then of their combinations, in the order of the codes of `Status`.
_BOUNDS: Final = [
    *(
        _interval(POSITIVE_OR_RIGID, OR_INFINITE)
        if name in _INFINITE
        else _interval(quantity.bounds, quantity.limits)
        for name, quantity in _ARGUMENTS.items()
    ),
    *(_interval(QUANTITIES[name].limits) for name in ("damping_ratio", "phase")),
]

# Variables that hold numbers, by the names of the table of quantities; the one that says yes or no.
_SETTLED: Final = "transient_settled"
_SETTLING_TIME: Final = "transient_settling_time"
_USUAL: Final = {
    q.variable: q.name
    for q in (*TRANSIENT, *ENDING, QUANTITIES["duration"])
    if q.variable != _SETTLED
}
_LEDGER: Final = {q.variable: q.name for q in ENERGY}
_NUMBERS: Final = _USUAL | _LEDGER | {q.variable: q.name for q in FINAL}
_BESIDE: Final = ("ending", "events", _SETTLED)
_OUTPUT_NAMES: Final = number_names(
    {name: QUANTITIES[full] for name, full in _NUMBERS.items()}
    | {_SETTLED: QUANTITIES["transient.settled"]}
    | dict.fromkeys(("ending", "events", "status"))
)


def simulate_batch(
    drive: Drive,
    release: Release,
    *,
    energy: bool = False,
    outputs: Sequence[str] | None = None,
    threads: int | None = None,
    **varied: ArrayLike | xr.DataArray | None,
) -> xr.Dataset:
    """Follow many pins from their release, each exactly as `simulate` does, and keep the numbers.

    The varied arguments broadcast as NumPy's do: numbers, arrays, or xarray DataArrays, whose
    dimensions go by their names; where text has a unit, it may stand for a number. No trajectory is
    stored. Python runs on meanwhile, and Ctrl-C ends a batch.

    Args:
        drive: Drive with all values that are not varied.
        release: Release with all values that are not varied.
        energy: The terms of the energy ledger too; a point then takes some fifty times as long.
        outputs: The variables to compute and return, among them `final_position` and
            `final_velocity`, the state at the end; None: all others, and with `energy` those of the
            ledger. `status` is always there. The fewer, the faster: the state alone takes a third
            of the time of all numbers.
        threads: Number of threads, at least 1; None: all cores. The results are the same to the
            bit.
        **varied: Varied values: of the drive `mass`, `stiffness`, `damping` or `damping_ratio`,
            `plate_kinetic`, `plate_static`, `finger_kinetic`, `finger_static`, `finger_stiffness`
            (infinite: rigid), `finger_damping`; in place of forces, of a contact given by
            coefficients, `plate_coefficient`, `plate_static_coefficient`, `preload`,
            `touch_share`, `finger_coefficient`, `finger_static_coefficient`, `touch_force`,
            `load_exponent` and `reference_touch`; of the release
            `mouse_velocity`, `displacement`, `velocity`, `plate_load`; of the end stops `travel`,
            `stop_stiffness`
            and `stop_damping`; and `duration` (infinite: long enough to see each ending) and
            `settling_band`, as for `simulate`, which has their ranges. Keys of device files are
            names too: `**{"plate.kinetic": 0.02}`. Static friction that is None in a contact is the
            kinetic one, and a velocity that is None the plate's, at every point.

    Returns:
        Variables in the shape that the varied arguments have together, with unit and meaning in
        their attributes, named as in `outputs` or as in `Motion.to_dataset`. A dimension along
        which one argument varies, alone, has the name of that argument, so that
        `.sel(damping=0.1)` selects by value; another is `dim_0`, `dim_1` and so on. There are the
        numbers of the transient and the ending, and with `energy` those of the ledger; `ending`,
        how it ends, and `status`, both with their values and meanings in the attributes
        `flag_values` and `flag_meanings`; and the number of `events`. The coordinates are what was
        varied, and what drive and release have. A point that `simulate` would refuse does not stop
        the others: its status says which argument is bad (of a coefficient, the force that it
        makes), and its numbers are NaN.

    Raises:
        ValueError: An argument is unknown or holds something else than numbers, shapes do not fit
            together, `threads` is no count, or `outputs` names what there is not; friction is given
            both by a force and by a coefficient; what describes end stops lacks what it needs; a
            drive or a release has what only `simulate` follows: A friction curve, an input that
            changes, a given stretch of the skin.

    Warns:
        ImplausibleValueWarning: a value that no such device has, such as a velocity in mm/s.
    """
    varied = _named(varied)
    dataset, extremes = _followed(drive, release, varied, energy, outputs, threads)
    for name, argument in (_constants(drive, release, varied) | varied).items():
        if argument is not None:
            _warn(name, argument, extremes.get(name, (nan, nan)))
    asked = {_OUTPUT_NAMES.find(name, "outputs"): name.replace(".", "_") for name in outputs or ()}
    return dataset.rename({name: shown for name, shown in asked.items() if shown != name})


def batched(
    drive: Drive,
    release: Release,
    varied: Mapping[str, Broadcastable | None],
    *,
    energy: bool = False,
    outputs: Sequence[str] | None = None,
    threads: int | None = None,
) -> xr.Dataset:
    """Simulate a batch without warnings; None marks an argument that is not varied."""
    return _followed(drive, release, varied, energy, outputs, threads)[0]


def _followed(
    drive: Drive,
    release: Release,
    varied: Mapping[str, Broadcastable | None],
    energy: bool,
    outputs: Sequence[str] | None,
    threads: int | None,
) -> tuple[xr.Dataset, dict[str, tuple[float, float]]]:
    """The numbers; and the least and the largest value of each argument, NaN if one is NaN."""
    from pindrive import __version__

    workers = worker_count(threads)
    wanted = _wanted(outputs, energy)
    if all(varied.get(name) is not None for name in ("damping", "damping_ratio")):
        raise ValueError(refusal("damping", "given as damping or as damping_ratio", "both"))
    named: dict[str, Broadcastable] = {
        **_constants(drive, release, varied),
        **{name: value for name, value in varied.items() if value is not None},
    }
    sizes, arguments, coordinates = _shared_shape(named)
    shape = tuple(sizes.values())

    aligned = {k: _aligned(v, tuple(sizes)) for k, v in arguments.items()}
    aligned |= _forces(aligned) | _damping(aligned)
    for name in _ARGUMENTS.keys() - aligned.keys():
        aligned[name] = aligned[_SAME_AS[name]] if name in _SAME_AS else np.array(_LEFT_OUT[name])
    spread = [np.broadcast_to(aligned[name], shape) for name in _ARGUMENTS]
    if np.isinf(aligned["duration"]).any():
        arguments.pop(
            "duration", None
        )  # the column then has the time until which the ending was sought
    else:
        wanted = [name for name in wanted if name != "duration"]
    computed = [_SETTLING_TIME if name == _SETTLED else name for name in wanted]
    numbers = [*dict.fromkeys(_NUMBERS[name] for name in computed if name in _NUMBERS)]
    table = _core.simulate_batch(
        spread, _BOUNDS, workers, numbers, "events" in wanted, 0, _others(aligned, shape)
    )
    if _SETTLED in wanted:
        settling_time = table[_NUMBERS[_SETTLING_TIME]]
        table[_SETTLED] = settling_time == settling_time  # not NaN
    columns = {name: table[_NUMBERS.get(name, name)] for name in wanted}
    coordinates |= {k: (v.dims, v.values, _attributes(k)) for k, v in arguments.items()}
    data = {
        name: (tuple(sizes), column.reshape(shape), _attributes(_NUMBERS.get(name, name)))
        for name, column in columns.items()
    }
    dataset = xr.Dataset(data, coordinates, {"source": f"pindrive {__version__}"})
    return dataset, dict(zip(_ARGUMENTS, table["extremes"], strict=True))


def _named(varied: Mapping[str, Broadcastable | None]) -> dict[str, Broadcastable | None]:
    """The varied arguments by their own names.

    Raises:
        ValueError: A name is unknown or given twice.
    """
    found: dict[str, Broadcastable | None] = {}
    for given, value in varied.items():
        name = _ARGUMENT_NAMES.find(given, "")
        if name in found:
            raise ValueError(f"{name} is given twice, once as {given}")
        found[name] = value
    return found


def _constants(
    drive: Drive, release: Release, varied: Mapping[str, Broadcastable | None]
) -> dict[str, Broadcastable]:
    """Return the constant arguments from drive and release, without missing ones."""
    check_fits(drive, release)
    plate, finger = drive.plate, drive.finger
    for name, contact in (("plate", plate), ("finger", finger)):
        if contact.curved:
            required = "without friction that depends on speed; `simulate` follows it"
            given = f"{len(contact.curve)} rows" if contact.curve else contact.law or "viscous"
            raise ValueError(refusal(name, required, given))
    if release.skin_stretch is not None:
        given = f"{release.skin_stretch!r} m"
        raise ValueError(refusal("skin_stretch", "left out; `simulate` follows it", given))
    for name in ("force", "across_velocity", "finger_load"):
        value, quantity = getattr(release, name), QUANTITIES[name]
        unit = "" if quantity.unit == "1" else f" {quantity.unit}"
        if value != quantity.absent:
            given = f"{value!r}{unit}" if isinstance(value, float) else f"a {type(value).__name__}"
            required = f"{quantity.absent:g}{unit}; `simulate` follows another"
            raise ValueError(refusal(name, required, given))
    has = {
        "mass": drive.mass,
        "stiffness": drive.stiffness,
        "damping": None if varied.get("damping_ratio") is not None else drive.damping,
        **_friction(drive, {name for name, value in varied.items() if value is not None}),
        "finger_stiffness": None if finger.rigid else finger.stiffness,
        "finger_damping": finger.damping,
        "mouse_velocity": release.mouse_velocity,
        "displacement": release.displacement,
        "velocity": release.velocity,
        "plate_load": release.plate_load,
        **{name: getattr(drive, name) for name in _STOPS},
    }
    found: dict[str, Broadcastable] = {}
    for name, value in has.items():
        if value is None or varied.get(name) is not None:
            continue
        if isinstance(value, (Profile, Function)):
            if value.changes:
                required = "constant; `simulate` follows one that changes"
                raise ValueError(refusal(name, required, f"a {type(value).__name__}"))
            value = value(0.0)
        found[name] = value
    return found


def _friction(drive: Drive, varied: Collection[str]) -> dict[str, float | None]:
    """The friction of a drive, by forces or by coefficients and what presses.

    Raises:
        ValueError: Both force and coefficient are given, or a touch force without a coefficient.
    """
    found: dict[str, float | None] = {}
    for table, contact in (("plate", drive.plate), ("finger", drive.finger)):
        names = [n for pair in COEFFICIENTS.items() for n in pair if f"{table}_{n}" in varied]
        by_coefficient = contact.coefficient is not None
        own = "coefficient" if by_coefficient else "kinetic"
        pressed = ["touch_force"] if table == "finger" and by_coefficient else []
        refuse({f"{table}.{name}": None for name in (own, *names, *pressed)})
        static = COEFFICIENTS["static"] if by_coefficient else "static"
        found |= {f"{table}_{name}": getattr(contact, name) for name in (own, static)}
        if by_coefficient:
            found |= {name: getattr(drive, name) for name in PRESSED_BY[table] if name != "mass"}
        elif table == "finger" and (
            given := [name for name in ("touch_force", "reference_touch") if name in varied]
        ):
            required = "left out where the finger's friction is given as a force"
            raise ValueError(refusal(given[0], required, "it"))
    return found


def _largest(values: NDArray[np.float64]) -> float | None:
    """The largest value but for NaN; None without one."""
    known = values[~np.isnan(values)]
    return float(known.max()) if known.size else None


def _others(
    given: Mapping[str, NDArray[np.float64]], shape: tuple[int, ...]
) -> list[NDArray[np.float64]]:
    """Travel, stiffness and damping of the end stops, damping of the skin; nothing: none of them.

    Each has one value, or one for each point: NaN where one is refused.

    Raises:
        ValueError: A value of stops or skin lacks the values that it needs.
    """
    values = {name: _allowed(q.name, given[name]) for name, q in _OTHERS.items() if name in given}
    refuse({f"drive.{name}": _largest(values[name]) for name in _STOPS if name in values})
    damping = values.get("finger_damping", np.array(0.0))
    if _largest(damping) and np.isinf(given["finger_stiffness"]).any():
        refuse({"finger.damping": _largest(damping)})
    if "travel" not in given and not damping.any():
        return []
    left_out = {"stop_stiffness": np.array(inf), "stop_damping": np.array(0.0)}
    left_out |= {"travel": np.array(inf), "finger_damping": np.array(0.0)}
    parts = [values.get(name, left_out[name]) for name in _OTHERS]
    return [
        np.ascontiguousarray(part if part.size == 1 else np.broadcast_to(part, shape)).ravel()
        for part in parts
    ]


def _damping(given: Mapping[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    """The damping that a damping ratio makes; NaN where the ratio is refused."""
    if "damping_ratio" not in given:
        return {}
    ratio = _allowed("damping_ratio", given["damping_ratio"])
    return {"damping": 2.0 * ratio * np.sqrt(given["mass"]) * np.sqrt(given["stiffness"])}


def _forces(given: Mapping[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    """Return the friction forces of the coefficients; NaN if a part is rejected."""

    def value(name: str) -> NDArray[np.float64] | None:
        key = name.replace(".", "_")
        return _allowed(name, given[key]) if key in given else None

    if "finger_coefficient" in given and "reference_touch" not in given:
        other = given["load_exponent"][given["load_exponent"] != 1.0]
        if other.size:
            pressed = {"finger.coefficient": None, "finger.touch_force": None}
            refuse(pressed | {"finger.load_exponent": float(other[0])})
    return {
        name.replace(".", "_"): friction_force(name, value)
        for name in _FORCES
        if COEFFICIENT_OF[name].replace(".", "_") in given
    }


# ---- what is computed ----------------------------------------------------------------------------


def _wanted(outputs: Sequence[str] | None, energy: bool) -> list[str]:
    """The variables to return; `status` is always one."""
    if outputs is None:
        return [*_USUAL, *(_LEDGER if energy else ()), "status", *_BESIDE]
    if isinstance(outputs, str):
        raise ValueError(refusal("outputs", "a list of names", repr(outputs)))
    found = [_OUTPUT_NAMES.find(name, "outputs") for name in outputs]
    return [*dict.fromkeys([*found, *(_LEDGER if energy else ()), "status"])]


# ---- shapes --------------------------------------------------------------------------------------

Shared = tuple[dict[str, int], dict[str, "xr.Variable"], dict[str, Any]]
"""The dimensions that the arguments have together, each argument with its own, the coordinates."""


def _shared_shape(given: Mapping[str, Broadcastable]) -> Shared:
    """The arguments as variables, whose dimensions are named or, as arrays have none, counted."""
    named = {k: v for k, v in given.items() if isinstance(v, xr.DataArray)}
    arrays = {k: _floats(k, v) for k, v in given.items() if k not in named}
    return _by_name(named, arrays) if named else _by_position(arrays)


def _by_name(
    named: Mapping[str, xr.DataArray], arrays: Mapping[str, NDArray[np.float64]]
) -> Shared:
    for name, array in arrays.items():
        if array.ndim:
            required = "a number or a DataArray where another argument is a DataArray"
            raise ValueError(refusal(name, required, f"an array of shape {array.shape}"))
    xr.align(*named.values(), join="exact", copy=False)  # raises where coordinates differ
    coordinates = xr.merge([v.coords.to_dataset() for v in named.values()], join="exact").coords
    variables = {k: xr.Variable(v.dims, _floats(k, v.values)) for k, v in named.items()}
    sizes = {str(dim): n for v in variables.values() for dim, n in v.sizes.items()}
    variables |= {k: xr.Variable((), array) for k, array in arrays.items()}
    return sizes, variables, {str(k): v for k, v in coordinates.items()}


def _by_position(arrays: Mapping[str, NDArray[np.float64]]) -> Shared:
    shape = _common_shape(arrays)
    sizes = {f"dim_{axis}": length for axis, length in enumerate(shape)}
    variables = {}
    for name, array in arrays.items():
        axes = range(len(shape) - array.ndim, len(shape))
        spread = tuple(i for i, axis in enumerate(axes) if array.shape[i] < shape[axis])
        dims = [f"dim_{axis}" for i, axis in enumerate(axes) if i not in spread]
        variables[name] = xr.Variable(dims, array.squeeze(spread))
    names = _names_of_dimensions(variables)
    variables = {
        k: xr.Variable([names.get(str(d), str(d)) for d in v.dims], v) for k, v in variables.items()
    }
    return {names.get(dim, dim): n for dim, n in sizes.items()}, variables, {}


def _names_of_dimensions(variables: Mapping[str, xr.Variable]) -> dict[str, str]:
    """Return the names of the dimensions along which a single argument varies, alone."""
    along: dict[str, list[str]] = {}
    for name, variable in variables.items():
        for dim in variable.dims:
            along.setdefault(str(dim), []).append(name)
    # With `duration` varied, the column of that name holds what each motion took.
    return {
        dim: names[0]
        for dim, names in along.items()
        if len(names) == 1 and len(variables[names[0]].dims) == 1 and names != ["duration"]
    }


def _common_shape(arrays: Mapping[str, NDArray[np.float64]]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items() if array.ndim)
        raise ValueError(refusal("arguments", "of shapes that broadcast", shapes)) from None


def _aligned(variable: xr.Variable, dims: tuple[str, ...]) -> NDArray[np.float64]:
    """Its values with all axes in order; one that it lacks is one long, as NumPy spreads it."""
    own = [dim for dim in dims if dim in variable.dims]
    values: NDArray[np.float64] = variable.transpose(*own).values
    return np.expand_dims(values, [i for i, dim in enumerate(dims) if dim not in own])


def _floats(name: str, values: object) -> NDArray[np.float64]:
    """An argument as an array of floats, if it holds numbers; masked entries are NaN."""
    if isinstance(values, np.ma.MaskedArray) and values.dtype.kind in "iuf":
        values = np.ma.filled(values.astype(np.float64), nan)
    try:
        array = np.asarray(values)
    except ValueError:  # rows of unlike length
        array = np.empty(0, np.object_)
    if array.dtype.kind == "U":
        texts = (check(_TAKEN[name].name, str(text), label=name) for text in array.flat)
        return np.fromiter(texts, np.float64, array.size).reshape(array.shape)
    if array.dtype.kind not in "iuf":
        raise ValueError(refusal(name, _TAKEN[name].kinds, repr(values)))
    return array.astype(np.float64, copy=False)


def _warn(name: str, given: Broadcastable, ends: tuple[float, float]) -> None:
    """Warn of the largest or the smallest value that is computed, if no such device has it."""
    quantity = _TAKEN[name]
    seen = quantity.seen
    if seen is None:
        return
    if ends[0] * ends[1] > 0.0 and all(
        abs(end) in seen and end in quantity.bounds and end in quantity.limits for end in ends
    ):
        return  # nothing beyond, without a look at each
    values = _floats(name, getattr(given, "values", given))
    good = _within(quantity.bounds, values) & _within(quantity.limits, values) & np.isfinite(values)
    sizes = np.abs(values[good])
    if not sizes.size:
        return
    for size in (sizes.max(), sizes.min()):
        if float(size) not in seen:
            warn_of(quantity.name, float(size), label=name, stacklevel=3)
            return


def _allowed(name: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The values of a quantity, NaN where one is out of its range."""
    quantity = QUANTITIES[name]
    good = _within(quantity.bounds, values) & _within(quantity.limits, values)
    return np.where(good, values, nan)


def _within(bounds: Bounds, values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return True for the values within the bounds; NaN never is."""
    above = values >= bounds.lower if bounds.lower_closed else values > bounds.lower
    below = values <= bounds.upper if bounds.upper_closed else values < bounds.upper
    return (above & below) | np.equal(values, nan if bounds.also is None else bounds.also)


# ---- what the numbers mean -----------------------------------------------------------------------


def _attributes(name: str) -> dict[str, Any]:
    """Return the attributes of a variable of the dataset."""
    if name in OUTCOMES:
        return outcome_attributes(name)
    named = "transient.settled" if name == _SETTLED else name
    return {**(_TAKEN[name] if name in _TAKEN else QUANTITIES[named]).attributes}
