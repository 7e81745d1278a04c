"""Notations of an axis in a study file: a list, a table with one distribution, or a tolerance."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import inf
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Final, cast

from pindrive.files.keys import DRIVE, NAMES, NUMERIC_KEYS, PARAMETERS, TABLES, has_part, number
from pindrive.quantities import budgets
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.units import UnitError, to_si
from pindrive.study.distributions import KINDS, Axis, Distribution, Even, Kind, Linked, Listed


@dataclass(frozen=True, slots=True)
class Source:
    """Place where a study or a design problem is written.

    Attributes:
        path: File that a computation must not overwrite; paths in tables are relative to its
            folder.
        place: Name of the tables in messages.
        text: Text that is stored with the numbers.
        si: True if bare numbers are SI, as from Python.
    """

    path: Path
    place: str
    text: str = ""
    si: bool = False


_KINDS: Final = ("lin", "log", "list", *KINDS, "times")
_BESIDE: Final = {"lin": ("count",), "log": ("count",), "list": (), "times": ("of",)}


def written_axes(table: Mapping[str, Any], within: str = "") -> Iterator[tuple[str, Any]]:
    """The keys of [axes] and what is written for each, whether under its table or in full.

    Args:
        table: Table of TOML, in which "mouse_velocity.amplitude" is a table in a table.
        within: Beginning of the keys.
    """
    for name, spec in table.items():
        given = f"{within}{name}"
        if isinstance(spec, dict) and (given in TABLES or _has_parameters(given, spec)):
            yield from written_axes(spec, f"{given}.")
        else:
            yield given, spec


def _has_parameters(given: str, spec: Mapping[str, Any]) -> bool:
    """Return True if a table under the name of an input has parameters of a function."""
    return any(key in PARAMETERS for name in spec for key in NAMES.matches(f"{given}.{name}"))


def sweepable(given: str, place: str, scans: bool) -> str:
    """The key that is meant, if it holds a number and has a part in scans, or else in releases.

    Raises:
        ValueError: The key is unknown, ambiguous, no number, or has no part in the study.
    """
    key = NAMES.find(given, place)
    if key not in NUMERIC_KEYS or not NUMERIC_KEYS[key].may_be_constant:
        raise ValueError(f"{place}: {key} is no single number, it cannot be varied")
    if not has_part(key, scans):
        why = (
            "has no part in a scan, in which the hand moves the mouse; leave out [page] to vary it"
            if key in DRIVE
            else 'acts in a scan; say what is on the page, as with grating = ["4 mm"] in [page]'
        )
        raise ValueError(f"{place}: {key} {why}")
    return key


class AxisReader:
    """Reads what is written for one key; says mistakes with the place and the key."""

    def __init__(
        self, source: Source, table: str, key: str, base: float | None, *, scans: bool
    ) -> None:
        self._file, self._label, self._key = source.place, f"{table}.{key}", key
        self._quantity: Quantity = NUMERIC_KEYS[key]
        self._base, self._scans, self._si = base, scans, source.si
        self._tolerance = table == "tolerances"

    def read(self, spec: object) -> Axis:
        """The axis.

        Raises:
            ValueError: The axis is malformed, empty, or out of the bounds of the key.
        """
        if self._tolerance and isinstance(spec, str):
            return self._around(spec)
        if isinstance(spec, list) and not self._tolerance:
            return self._listed(spec, "")
        kinds = [kind for kind in _KINDS if kind in spec] if isinstance(spec, dict) else []
        if not isinstance(spec, dict) or len(kinds) != 1:
            raise ValueError(self._refusal(self._expected(), spec))
        kind = kinds[0]
        beside = _BESIDE.get(kind, ("within",))
        for name in spec:
            if name not in (kind, *beside):
                known = " and ".join((kind, *beside))
                raise ValueError(
                    f"{self._file}: unknown key {self._label}.{name}; there is {known}"
                )
        if kind == "times":
            return self._linked(spec)
        if kind in KINDS:
            return self._distribution(kind, spec)
        if self._tolerance:
            raise ValueError(self._refusal(self._expected(), spec))
        if kind == "list":
            return self._listed(spec["list"], ".list")
        return self._even(kind, spec)

    def _expected(self) -> str:
        a, b = (quoted(self._quantity.written(x)) for x in self._example())
        if self._tolerance:
            return f'a tolerance like "20 %" or {{ uniform = [{a}, {b}] }}'
        return f"a list of values, or a table like {{ lin = [{a}, {b}], count = 10 }}"

    def _example(self) -> tuple[float, float]:
        quantity = self._quantity
        value = self._base or quantity.default or quantity.example or 1.0
        return 0.5 * value, 2.0 * value

    def _refusal(self, required: str, given: object, part: str = "") -> str:
        return refusal(f"{self._label}{part}", required, quoted(given), self._file)

    def _value(self, given: object, part: str) -> float:
        """One value in SI, within the key's bounds."""
        quantity, label = self._quantity, f"{self._label}{part}"
        return number(given, quantity, quantity.usual, label, self._file, si=self._si)

    def _pair(self, given: object, part: str, names: tuple[str, str]) -> list[Any]:
        if not isinstance(given, list) or len(given) != 2:
            raise ValueError(self._refusal(f"two values, [{', '.join(names)}]", given, part))
        return given

    def _listed(self, values: object, part: str) -> Listed:
        if not isinstance(values, list) or not values:
            raise ValueError(self._refusal("a list of at least one value", values, part))
        return Listed(tuple(self._value(v, f"{part}[{i}]") for i, v in enumerate(values)))

    def _even(self, kind: str, spec: Mapping[str, Any]) -> Even:
        pair = self._pair(spec[kind], f".{kind}", ("first", "last"))
        low, high = (self._value(v, f".{kind}[{i}]") for i, v in enumerate(pair))
        if low == high:
            raise ValueError(self._refusal("two different values", pair, f".{kind}"))
        if kind == "log" and not min(low, high) > 0.0:
            raise ValueError(self._refusal("two values greater than 0", pair, ".log"))
        count = spec.get("count")
        if type(count) is not int or not 2 <= count <= budgets.AXIS.most:
            given = "none" if count is None else quoted(count)
            required = f"a whole number from 2 to {budgets.AXIS.most}"
            raise ValueError(refusal(f"{self._label}.count", required, given, self._file))
        return Even(low, high, count, kind == "log")

    def _linked(self, spec: Mapping[str, Any]) -> Linked:
        of = spec.get("of")
        if not isinstance(of, str):
            raise ValueError(
                self._refusal('the key that it follows, like of = "plate.kinetic"', of, ".of")
            )
        key = sweepable(of, f"{self._file}: {self._label}.of", self._scans)
        if key == self._key or NUMERIC_KEYS[key].unit != self._quantity.unit:
            unit = self._quantity.unit
            required = f"another key {'without a unit' if unit == '1' else f'in {unit}'}"
            raise ValueError(self._refusal(required, of, ".of"))
        return Linked(key, self._plain(spec["times"], ".times"))

    def _plain(self, given: object, part: str) -> float:
        if isinstance(given, bool) or not isinstance(given, (int, float)) or not abs(given) < inf:
            raise ValueError(self._refusal("a plain finite number", given, part))
        return float(given)

    def _distribution(self, kind: Kind, spec: Mapping[str, Any]) -> Distribution:
        part, names = f".{kind}", KINDS[kind]
        if kind == "normal" and isinstance(spec[kind], str) and self._tolerance:
            first, second = self._about(part, spec[kind]), self._spread(spec[kind], part)
        else:
            pair = self._pair(spec[kind], part, names)
            first = self._value(pair[0], f"{part}[0]")
            if kind == "normal":
                second = self._spread(pair[1], f"{part}[1]", first)
            elif kind == "lognormal":
                second = self._plain(pair[1], f"{part}[1]")
            else:
                second = self._value(pair[1], f"{part}[1]")
        if kind in ("uniform", "loguniform") and not first < second:
            raise ValueError(self._refusal("a lowest and a highest value", spec[kind], part))
        if kind in ("loguniform", "lognormal") and not first > 0.0:
            raise ValueError(self._refusal(f"a {names[0]} greater than 0", spec[kind], part))
        if kind == "lognormal" and not second > 1.0:
            raise ValueError(self._refusal("a factor greater than 1", pair[1], f"{part}[1]"))
        bounds = self._quantity.bounds
        found = Distribution(kind, first, second, bounds.lower, bounds.upper)
        if "within" not in spec:
            return found
        pair = self._pair(spec["within"], ".within", ("lowest", "highest"))
        low, high = (self._value(v, f".within[{i}]") for i, v in enumerate(pair))
        if not low < high:
            raise ValueError(self._refusal("a lowest and a highest value", pair, ".within"))
        if kind in ("uniform", "loguniform"):
            raise ValueError(self._refusal(f"left out, {kind} has its own ends", pair, ".within"))
        return replace(found, lower=low, upper=high)

    def _around(self, text: str) -> Distribution:
        """A tolerance about the device's own value: "20 %" or "4 mN" either way."""
        base = self._about("", text)
        off = self._spread(text.strip().removeprefix("±"), "", base)
        low, high = base - off, base + off
        for end in (low, high):
            if end not in self._quantity.bounds:
                shown = f"{quoted(text)}, which reaches {self._quantity.written(end)}"
                unit = self._quantity.unit
                words = self._quantity.bounds.words("" if unit == "1" else unit)
                raise ValueError(refusal(self._label, words, shown, self._file))
        return Distribution("uniform", low, high)

    def _about(self, part: str, given: object) -> float:
        if self._base is None:
            raise ValueError(
                self._refusal("given with its ends, the device has no value", given, part)
            )
        return self._base

    def _spread(self, given: object, part: str, about: float | None = None) -> float:
        """A deviation in SI, greater than 0; "5 %" is a part of the value that it is about."""
        about = self._base if about is None else about
        quantity, text = self._quantity, given.strip() if isinstance(given, str) else ""
        relative = text.endswith("%")
        example = quantity.usual
        try:
            if relative:
                off = to_si(text, "1", "5 %") * abs(about or 0.0)
            elif self._si and type(given) in (int, float):
                off = float(cast(float, given))
            else:
                off = to_si(text or repr(given), quantity.unit, example)
        except UnitError as error:
            raise ValueError(self._refusal(f"{error} or a percentage", given, part)) from None
        if not 0.0 < off < inf:
            raise ValueError(self._refusal("a deviation greater than 0", given, part))
        return off


def as_read(axes: Mapping[str, Any] | None, label: str) -> dict[str, Any] | None:
    """Axes from Python with the types that TOML has: arrays are lists, their numbers plain.

    Raises:
        ValueError: The axes are no mapping.
    """
    if axes is None:
        return None
    if not isinstance(axes, Mapping):
        example = 'a mapping, like {"mass": [0.01, 0.02]}'
        raise ValueError(refusal(label, example, repr(axes)))
    return {given: _plain(spec) for given, spec in axes.items()}


def _plain(spec: Any) -> Any:
    if isinstance(spec, str):
        return str(spec)
    if isinstance(spec, Mapping):
        return {part: _plain(inner) for part, inner in spec.items()}
    if isinstance(spec, Iterable):
        return [_plain(inner) for inner in spec]
    if isinstance(spec, Real) and not isinstance(spec, bool):
        return int(spec) if isinstance(spec, Integral) else float(spec)
    return spec
