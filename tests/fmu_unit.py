"""An FMU as an importer drives it, over FMPy."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from typing import Any, Self
from zipfile import ZipFile

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from pindrive.files.device import DeviceFile
from pindrive.files.fmu import write_fmu

LOADING = Lock()
"""FMPy changes the folder of the whole process while it loads a library."""


class Unit:
    """An instance of an FMU of either version, by the names of its variables."""

    def __init__(self, folder: Path, description: Any, **events: bool) -> None:
        self.numbers = {v.name: v.valueReference for v in description.modelVariables}
        self.version = int(description.fmiVersion[0])
        made = FMU2Slave if self.version == 2 else FMU3Slave
        with LOADING:
            self.slave = made(
                guid=description.guid if self.version == 2 else description.instantiationToken,
                unzipDirectory=str(folder),
                modelIdentifier=description.coSimulation.modelIdentifier,
                instanceName="pin",
            )
        self.slave.instantiate(**events)

    def begin(self, **start: float) -> Self:
        """From instantiation to the first step."""
        if self.version == 2:
            self.slave.setupExperiment(startTime=0.0)
            self.slave.enterInitializationMode()
        else:
            self.slave.enterInitializationMode(startTime=0.0)
        self.set(**start)
        self.slave.exitInitializationMode()
        self.time = 0.0
        return self

    def set(self, **values: float) -> None:
        for name, value in values.items():
            put = self.slave.setReal if self.version == 2 else self.slave.setFloat64
            put([self.numbers[name.replace("__", ".")]], [value])

    def command(self, **values: bool) -> None:
        for name, value in values.items():
            self.slave.setBoolean([self.numbers[name]], [value])

    def commanded(self, name: str) -> bool:
        (found,) = self.slave.getBoolean([self.numbers[name]])
        return bool(found)

    def get(self, *names: str) -> list[float]:
        real = self.slave.getReal if self.version == 2 else self.slave.getFloat64
        whole = self.slave.getInteger if self.version == 2 else self.slave.getInt32
        return [
            (whole if name.endswith("_state") else real)([self.numbers[name]])[0] for name in names
        ]

    def step(self, until: float) -> Any:
        size = until - self.time
        said = self.slave.doStep(currentCommunicationPoint=self.time, communicationStepSize=size)
        self.time = until if self.version == 2 else said[3]
        return said

    @contextmanager
    def astray(self, random: np.random.Generator, *names: str) -> Iterator[None]:
        """A unit returns to the stored values of its names after any calls.

        Its state is kept, or written to bytes and read again.
        """
        state, at, before = self.slave.getFMUState(), self.time, self.get(*names)
        kept = self.slave.serializeFMUState(state)
        yield
        if random.integers(2):
            self.slave.freeFMUState(state)
            state = self.slave.deserializeFMUState(kept)
        self.slave.setFMUState(state)
        self.slave.freeFMUState(state)
        self.time = at
        assert self.get(*names) == before

    def derivative(self, unknown: str, **seeds: float) -> float:
        numbers = [self.numbers[name.replace("__", ".")] for name in seeds]
        found = self.slave.getDirectionalDerivative(
            [self.numbers[unknown]], numbers, [*seeds.values()]
        )
        return float(found[0])


def unpacked(
    device: DeviceFile, path: Path, version: int, *, control: bool = False
) -> tuple[Path, Any]:
    """The folder and the description of the FMU of a device, written to `path` and unpacked."""
    write_fmu(device, path, version, control=control)
    folder = path.with_suffix("")
    with ZipFile(path) as archive:
        archive.extractall(folder)
    return folder, fmpy.read_model_description(str(path), validate=True)
