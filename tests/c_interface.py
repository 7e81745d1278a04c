"""The C interface over ctypes: the installed library and its structures."""

from __future__ import annotations

import ctypes
import sys
from ctypes import POINTER, c_char_p, c_double, c_size_t, c_void_p
from pathlib import Path
from typing import Any

import numpy as np

from core_case import Case


def doubles(values: Any) -> Any:
    """An array as C takes it."""
    return np.ascontiguousarray(values, float).ctypes.data_as(POINTER(c_double))


class Interface:
    """The installed library."""

    def __init__(self, c_library: Path) -> None:
        name = "libpindrive.dylib" if sys.platform == "darwin" else "libpindrive.so"
        self.library = ctypes.CDLL(str(c_library / "lib" / name))
        for function in ("drive_new", "release_new", "drive_rate_new", "release_rate_new"):
            getattr(self.library, f"pindrive_{function}").restype = c_void_p
        for function in ("number", "energy", "certificate"):
            getattr(self.library, f"pindrive_{function}_count").restype = c_size_t
            getattr(self.library, f"pindrive_{function}_name").restype = c_char_p
        self.library.pindrive_last_error.restype = c_char_p
        self.library.pindrive_status_text.restype = c_char_p

    def __call__(self, name: str, *arguments: Any) -> int:
        """Calls a function that may fail, which it must not; 1 where there was more."""
        error: int = getattr(self.library, f"pindrive_{name}")(*arguments)
        assert error <= 1, self.library.pindrive_last_error()
        return error

    def names(self, of: str) -> list[str]:
        count = getattr(self.library, f"pindrive_{of}_count")()
        name = getattr(self.library, f"pindrive_{of}_name")
        return [name(c_size_t(i)).decode() for i in range(count)]

    def filled(self, case: Case, drive: c_void_p, release: c_void_p) -> tuple[c_void_p, c_void_p]:
        """A drive and a release with the numbers of a case."""
        for contact, rows in case.curves.items():
            if rows:
                speeds, forces = zip(*rows, strict=True)
                count = c_size_t(len(rows))
                self(
                    "drive_set_curve",
                    drive,
                    contact.encode(),
                    *map(doubles, (speeds, forces)),
                    count,
                )
        for name, value in case.numbers.items():
            ours = name in ("displacement", "velocity", "skin_stretch", "duration")
            target, of = (release, "release") if ours else (drive, "drive")
            self(f"{of}_set", target, name.encode(), c_double(value))
        for name, rows in case.inputs.items():
            times, values = map(doubles, zip(*rows, strict=True))
            self("release_set_profile", release, name.encode(), times, values, c_size_t(len(rows)))
        return drive, release

    def given(self, case: Case) -> tuple[c_void_p, c_void_p]:
        new = (self.library.pindrive_drive_new, self.library.pindrive_release_new)
        return self.filled(case, *(c_void_p(make()) for make in new))

    def rate(self, case: Case, drive: c_void_p, release: c_void_p) -> tuple[c_void_p, c_void_p]:
        of_drive, of_release = (
            c_void_p(make(of))
            for make, of in (
                (self.library.pindrive_drive_rate_new, drive),
                (self.library.pindrive_release_rate_new, release),
            )
        )
        return self.filled(case, of_drive, of_release)

    def free(self, **handles: c_void_p) -> None:
        for kind, handle in handles.items():
            getattr(self.library, f"pindrive_{kind.partition('_')[0]}_free")(handle)


QUANTITIES = (
    *("position", "velocity", "acceleration", "plate_force", "finger_force"),
    *("stretch", "stretch_rate", "housing_force", "stop_force"),
)
"""In the order of pindrive_quantity."""


class Outcome(ctypes.Structure):
    """pindrive_outcome."""

    _fields_ = (
        ("status", ctypes.c_int),
        ("end", ctypes.c_int),
        ("steady_since", c_double),
        ("period", c_double),
        ("known_until", c_double),
        ("simulated", c_double),
        ("cycle_begin", c_double),
        ("segments", c_size_t),
    )


class Segment(ctypes.Structure):
    """pindrive_segment."""

    _fields_ = (
        *((name, c_double) for name in ("begin", "end", "position", "velocity", "acceleration")),
        ("acceleration_bound", c_double),
        *((name, ctypes.c_int) for name in ("plate", "finger", "plate_branch", "finger_branch")),
        *((name, ctypes.c_int) for name in ("plate_event", "finger_event", "stop", "stop_event")),
    )


class Event(ctypes.Structure):
    """pindrive_event."""

    _fields_ = (
        *((name, c_double) for name in ("time", "position", "velocity")),
        *((name, ctypes.c_int) for name in ("plate", "finger", "stop")),
    )
