"""A drive as a functional mock-up unit: variables from the table of quantities, and the archive.

The library inside is the same for every drive: it reads the variables, and their start values, from
the list that the archive carries beside the description.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from hashlib import sha256
from importlib import resources
from math import inf, isfinite
from pathlib import Path
from typing import Final
from uuid import UUID
from xml.etree.ElementTree import Element, SubElement, indent, tostring
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from pindrive.device.coil import DataSheet
from pindrive.device.electromagnet import DIRECT, TIMES
from pindrive.files.device import DeviceFile
from pindrive.files.keys import NUMERIC_KEYS, PARAMETERS
from pindrive.motion.friction import COEFFICIENTS
from pindrive.motion.function import Function
from pindrive.motion.release import INPUTS
from pindrive.motion.release import initial as value_at_begin
from pindrive.quantities.drive import COLUMNS, SUPPORTS
from pindrive.quantities.quantity import DISPLAY, Quantity
from pindrive.quantities.refusal import refusal
from pindrive.quantities.results import SERIES
from pindrive.quantities.table import QUANTITIES

VERSIONS: Final = (2, 3)
"""Supported versions of FMI."""
IDENTIFIER: Final = "pindrive"
"""The name of the library in the archive."""
_PLATFORMS_2: Final = {
    "x86_64-linux": "linux64",
    "x86_64-windows": "win64",
    "x86_64-darwin": "darwin64",
}
"""Platform names of FMI 2 by the platform names of FMI 3."""

_TYPES_2: Final = {"Float": "Real", "Int": "Integer", "Boolean": "Boolean"}
_TYPES_3: Final = {"Float": "Float64", "Int": "Int32", "Boolean": "Boolean"}
"""Type names of variables in FMI 2 and 3."""
_OUTPUTS: Final = (
    *("position", "velocity", "acceleration", "plate_force", "finger_force"),
    *("stretch", "stretch_rate", "housing_force"),
)
_STATES: Final = "-1 slips backward, 0 sticks, 1 slips forward, 2 absent, 3 sticks elastically"
_BASE: Final = {
    "kg": {"kg": 1},
    "m": {"m": 1},
    "s": {"s": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "m/s": {"m": 1, "s": -1},
    "m/s^2": {"m": 1, "s": -2},
    "1/s": {"s": -1},
    "N/s": {"kg": 1, "m": 1, "s": -3},
    "N/m": {"kg": 1, "s": -2},
    "N*s/m": {"kg": 1, "s": -1},
    "Hz": {"s": -1},
    "rad": {"rad": 1},
    "m^2": {"m": 2},
    "K": {"K": 1},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "T": {"kg": 1, "s": -2, "A": -1},
    "K/W": {"K": 1, "kg": -1, "m": -2, "s": 3},
    "J/K": {"kg": 1, "m": 2, "s": -2, "K": -1},
}
"""Units of the variables as powers of SI base units."""
_RATES: Final = {"m/s": "m/s^2", "1": "1/s", "N": "N/s"}
"""Units of the rates of inputs by the units of the inputs."""


ELSEWHERE: Final = {
    "motion.duration": "the stop time of the default experiment",
    "motion.settling_band": "criterion of the evaluation: the motion does not depend on it",
    "motion.support": "the spring stands in the mouse, which the importer moves",
    "magnet.outer_diameter": "says whether the device can be built",
    "magnet.spring_height": "says whether a magnet tips",
    "magnet.pin_height": "says whether a magnet tips",
    "magnet.height": "says whether the device can be built",
    "magnet.temperature_rise": "limit of the warming: the motion does not depend on it",
    "control": "the importer commands the magnet, unless the unit has the control block",
    "array": "the unit is one pin of it",
    "scan": "the importer moves the plate",
    "hand": "the importer moves the plate",
    "criteria": "criterion of the evaluation: the motion does not depend on it",
}
"""The keys and tables of a device file that are no variables of its unit, and why."""
COMMAND: Final = "magnet_on"
"""The input that commands the magnet of a whole device, in place of the plate's load."""
LUMINANCE: Final = "luminance"
"""The input of a unit with the control block, in place of the command."""


@dataclass(frozen=True, slots=True)
class FmuVariable:
    """A variable of the unit."""

    name: str
    kind: str
    """"parameter", "input", "command" (a Boolean input), "luminance" (an input) or "output"."""
    meaning: str
    unit: str
    start: float | None = None
    """SI; of a command 0 or 1; None: an output."""
    least: float = -inf
    largest: float = inf
    whole: bool = False
    """True for a whole number, which changes at events only."""

    @property
    def type(self) -> str:
        """Float, Int or Boolean."""
        return "Boolean" if self.kind == "command" else "Int" if self.whole else "Float"

    @property
    def causality(self) -> str:
        """As FMI calls it."""
        return "input" if self.kind in ("command", "luminance") else self.kind


def variables_of(device: DeviceFile, control: bool = False) -> list[FmuVariable]:
    """The variables of a device's drive, in the order of their numbers, which begin with 1.

    Args:
        device: A device file.
        control: True for a unit with the control block, which samples an input luminance.

    Raises:
        ValueError: The file of a unit with the control block describes no whole device.

    Parameters are the keys as the file gives them, or whose values hold where it does not; rows
    are parameters one by one. A file of the whole device has the magnet too, whose command is an
    input in place of the plate's load.
    """
    if control and not device.whole:
        required = "the file of a whole device, where a unit has the control block"
        raise ValueError(refusal("device", required, "a drive"))
    magnet = _magnet_outputs(device) if device.whole else ()
    return [*_parameters(device, control), *_inputs(device, control), *_outputs(magnet)]


def _parameters(device: DeviceFile, control: bool) -> Iterator[FmuVariable]:
    values = device.values()
    elsewhere = {*ELSEWHERE} - ({"control"} if control else set())
    functions = {f"motion.{name}" for name in _functions_of(device)}
    left_out = {*device.derived, *elsewhere, *(f"motion.{name}" for name in INPUTS)}
    for contact in ("plate", "finger"):
        for kinetic, static, rows, breakaway, _ in (
            tuple(COEFFICIENTS),
            tuple(COEFFICIENTS.values()),
        ):
            if values[f"{contact}.{rows}"] is not None:  # the first row is the kinetic friction
                left_out.add(f"{contact}.{kinetic}")
            if values[f"{contact}.{static}"] is None:
                at_rest = values[f"{contact}.{breakaway}"]
                kinetic_value = values[f"{contact}.{kinetic}"]
                values[f"{contact}.{static}"] = kinetic_value if at_rest is None else at_rest
    if device.whole and (coil := device.whole.magnet().coil):
        follow = TIMES if isinstance(coil, DataSheet) else DIRECT
        left_out.update(f"magnet.{name}" for name in follow)
    for key, value in values.items():
        if value is None or key in left_out or key.partition(".")[0] in elsewhere:
            continue
        if isinstance(value, Function):  # the parameters have keys
            continue
        if key in PARAMETERS and key.rpartition(".")[0] not in functions:
            continue
        row = PARAMETERS.get(key) or NUMERIC_KEYS[key]
        if not isinstance(value, tuple):
            yield _given(key, row, value)
            continue
        across, along = COLUMNS[row.rows_of]
        for i, (first, second) in enumerate(value, 1):
            yield _given(f"{key}.{across.rpartition('.')[2]}[{i}]", QUANTITIES[across], first)
            yield _given(f"{key}.{along.rpartition('.')[2]}[{i}]", row, second)


def _given(name: str, row: Quantity, value: float) -> FmuVariable:
    least, largest = row.limits.lower, row.limits.upper
    return FmuVariable(name, "parameter", row.meaning, row.unit, value, least, largest)


def inputs_of(device: DeviceFile) -> tuple[str, ...]:
    """Return the inputs of the unit, without their rates: those of a release that are no functions.

    The plate load is what the magnet makes of its command, where the file describes the magnet.
    """
    functions = _functions_of(device)
    return tuple(name for name in _free_inputs(device) if name not in functions)


def _free_inputs(device: DeviceFile) -> tuple[str, ...]:
    """Return the inputs of a release that the magnet of the unit does not make."""
    return tuple(name for name in INPUTS if not (device.whole and name == "plate_load"))


def _functions_of(device: DeviceFile) -> tuple[str, ...]:
    """Return the inputs that the file gives as functions of a few numbers."""
    given = ((name, getattr(device.release, name)) for name in _free_inputs(device))
    return tuple(n for n, value in given if isinstance(value, Function) and value.parameters)


def _inputs(device: DeviceFile, control: bool) -> Iterator[FmuVariable]:
    for name in inputs_of(device):
        row = QUANTITIES[name]
        value = value_at_begin(getattr(device.release, name))
        limits = row.limits
        yield FmuVariable(name, "input", row.meaning, row.unit, value, limits.lower, limits.upper)
        meaning = f"rate at which {name} continues until it is set again"
        yield FmuVariable(f"{name}_rate", "input", meaning, _RATES[row.unit], 0.0)
    if control:
        meaning = "luminance under the spot of the pin, which the control block samples"
        yield FmuVariable(LUMINANCE, "luminance", meaning, "1", 1.0, 0.0, 1.0)
    elif device.whole:
        meaning = "whether the magnet is commanded on, as by the control block"
        yield FmuVariable(COMMAND, "command", meaning, "", 0.0)


def _outputs(magnet: Iterable[FmuVariable]) -> Iterator[FmuVariable]:
    for name in _OUTPUTS:
        yield FmuVariable(name, "output", SERIES[name].meaning, SERIES[name].unit)
    meaning = (
        "time before which no contact changes while the inputs keep their rates; "
        "1.8e308 if none ever does"
    )
    yield FmuVariable("next_event_time", "output", meaning, "s")
    yield from magnet
    for contact in ("plate", "finger"):
        meaning = f"state of the contact with the {contact}: {_STATES}"
        yield FmuVariable(f"{contact}_state", "output", meaning, "", None, -1, 3, whole=True)


def _magnet_outputs(device: DeviceFile) -> Iterator[FmuVariable]:
    assert device.whole
    meaning = "current in the coil, a part of the full one at 20 °C"
    yield FmuVariable("magnet_current", "output", meaning, "1")
    yield FmuVariable("magnet_pull", "output", "pull of the magnet on the plate", "N")
    coil = device.whole.magnet().coil
    if coil and coil.heat_capacity is not None:
        yield FmuVariable("magnet_warming", "output", "warming of the coil above 20 °C", "K")


# ---- the archive ---------------------------------------------------------------------------------


def write_fmu(device: DeviceFile, path: Path, version: int = 3, *, control: bool = False) -> None:
    """Write a device's drive as a functional mock-up unit for co-simulation.

    Args:
        device: A device file; of the whole device one pin with its magnet.
        path: The archive.
        version: Version of FMI, one of `VERSIONS`.
        control: True for a unit with the control block of a whole device, whose input is luminance.

    Raises:
        ValueError: Another version; this installation has no library for an FMU; a control block
            of a file that describes no whole device.
    """
    if device.release.support != SUPPORTS[0]:
        required = f"{SUPPORTS[0]} in an FMU, whose input force can add the inertial force"
        raise ValueError(refusal("motion.support", required, device.release.support))
    if version not in VERSIONS:
        raise ValueError(f"version must be one of {', '.join(map(str, VERSIONS))}, got {version}")
    libraries = dict(_libraries(version))
    if not libraries:
        raise ValueError("fmu: this installation has no library for an FMU; install pindrive again")
    variables = variables_of(device, control)
    token, listed = _listed(variables)
    describe = _description_2 if version == 2 else _description_3
    files = {
        "modelDescription.xml": describe(device, variables, token),
        "resources/drive.txt": listed,
        **libraries,
    }
    with ZipFile(path, "w", ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = ZipInfo(name, (1980, 1, 1, 0, 0, 0))  # one drive makes one archive
            entry.compress_type, entry.external_attr = ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)


def _libraries(version: int) -> Iterator[tuple[str, bytes]]:
    """The library of each platform that is installed, by its name in the archive."""
    folder = resources.files("pindrive") / "fmu"
    if not folder.is_dir():
        return
    for platform in sorted(folder.iterdir(), key=lambda entry: entry.name):
        name = _PLATFORMS_2.get(platform.name, platform.name) if version == 2 else platform.name
        for library in platform.iterdir():
            yield f"binaries/{name}/{library.name}", library.read_bytes()


def _listed(variables: Iterable[FmuVariable]) -> tuple[str, bytes]:
    """A token of the variables with their start values, and the list that the library reads."""
    lines = [
        f"{variable.kind} {variable.name} {struct.pack('>d', variable.start or 0.0).hex()}"
        for variable in variables
    ]
    digest = sha256("\n".join(lines).encode()).digest()
    token = f"{{{UUID(bytes=digest[:16], version=4)}}}"
    return token, "\n".join(["pindrive-fmu-2", token, *lines, ""]).encode()


# ---- the descriptions ----------------------------------------------------------------------------


def _number(value: float) -> str:
    return repr(float(value))


def _root(device: DeviceFile, version: str, token_name: str, token: str) -> Element:
    from pindrive import __version__

    return Element(
        "fmiModelDescription",
        {
            "fmiVersion": version,
            "modelName": device.name or device.path.stem,
            token_name: token,
            "description": device.description or "A pin that friction moves, followed exactly",
            "generationTool": f"pindrive {__version__}",
            "variableNamingConvention": "structured",
        },
    )


def _units(parent: Element, variables: Iterable[FmuVariable]) -> None:
    units = SubElement(parent, "UnitDefinitions")
    for name in dict.fromkeys(v.unit for v in variables if v.unit in _BASE):
        unit = SubElement(units, "Unit", {"name": name})
        SubElement(unit, "BaseUnit", {base: str(power) for base, power in _BASE[name].items()})
        if name in DISPLAY:
            shown, scale = DISPLAY[name]
            SubElement(unit, "DisplayUnit", {"name": shown, "factor": _number(scale)})


def _attributes(variable: FmuVariable) -> dict[str, str]:
    """Unit, bounds and start value."""
    found = {"unit": variable.unit} if variable.unit in _BASE else {}
    if variable.unit in DISPLAY and variable.unit in _BASE:
        found["displayUnit"] = DISPLAY[variable.unit][0]
    if variable.type == "Boolean":
        return {"start": "true" if variable.start else "false"}
    write = (lambda value: str(int(value))) if variable.whole else _number
    if isfinite(variable.least):
        found["min"] = write(variable.least)
    if isfinite(variable.largest):
        found["max"] = write(variable.largest)
    if variable.start is not None:
        found["start"] = write(variable.start)
    return found


def _variability(variable: FmuVariable) -> str:
    if variable.kind == "parameter":
        return "fixed"
    discrete = variable.type != "Float" or variable.name == "next_event_time"
    return "discrete" if discrete else "continuous"


def _described(variable: FmuVariable, reference: int) -> dict[str, str]:
    initial = {"parameter": {"initial": "exact"}, "output": {"initial": "calculated"}}
    return {
        "name": variable.name,
        "valueReference": str(reference),
        "description": variable.meaning,
        "causality": variable.causality,
        "variability": _variability(variable),
        **initial.get(variable.kind, {}),
    }


def _experiment(root: Element, device: DeviceFile) -> None:
    stop = device.duration if device.duration is not None else 1.0
    SubElement(root, "DefaultExperiment", {"startTime": "0.0", "stopTime": _number(stop)})


def _document(root: Element) -> bytes:
    indent(root)
    text: bytes = tostring(root, "utf-8", xml_declaration=True)
    return text + b"\n"


def _description_2(device: DeviceFile, variables: list[FmuVariable], token: str) -> bytes:
    root = _root(device, "2.0", "guid", token)
    SubElement(
        root,
        "CoSimulation",
        {
            "modelIdentifier": IDENTIFIER,
            "canHandleVariableCommunicationStepSize": "true",
            "canInterpolateInputs": "true",
            "canGetAndSetFMUstate": "true",
            "canSerializeFMUstate": "true",
            "providesDirectionalDerivative": "true",
            "canNotUseMemoryManagementFunctions": "true",
        },
    )
    _units(root, variables)
    _experiment(root, device)
    listed = SubElement(root, "ModelVariables")
    structure = Element("ModelStructure")
    outputs = SubElement(structure, "Outputs")
    unknowns = SubElement(structure, "InitialUnknowns")
    for reference, variable in enumerate(variables, 1):
        described = _described(variable, reference)
        if variable.name.endswith("_rate") and variable.kind == "input":
            described["variability"] = "discrete"  # no rate of a rate is taken
        entry = SubElement(listed, "ScalarVariable", described)
        SubElement(entry, _TYPES_2[variable.type], _attributes(variable))
        if variable.kind == "output":
            for parent in (outputs, unknowns):
                SubElement(parent, "Unknown", {"index": str(reference)})
    root.append(structure)
    return _document(root)


def _description_3(device: DeviceFile, variables: list[FmuVariable], token: str) -> bytes:
    root = _root(device, "3.0", "instantiationToken", token)
    SubElement(
        root,
        "CoSimulation",
        {
            "modelIdentifier": IDENTIFIER,
            "canGetAndSetFMUState": "true",
            "canSerializeFMUState": "true",
            "providesDirectionalDerivatives": "true",
            "canHandleVariableCommunicationStepSize": "true",
            "mightReturnEarlyFromDoStep": "true",
            "hasEventMode": "true",
        },
    )
    _units(root, variables)
    _experiment(root, device)
    listed = SubElement(root, "ModelVariables")
    time = {"name": "time", "valueReference": "0", "causality": "independent"}
    SubElement(listed, "Float64", {**time, "variability": "continuous", "unit": "s"})
    structure = Element("ModelStructure")
    references = []
    for reference, variable in enumerate(variables, 1):
        described = _described(variable, reference) | _attributes(variable)
        SubElement(listed, _TYPES_3[variable.type], described)
        if variable.kind == "output":
            references.append(str(reference))
    for tag in ("Output", "InitialUnknown"):
        for number in references:
            SubElement(structure, tag, {"valueReference": number})
    root.append(structure)
    return _document(root)
