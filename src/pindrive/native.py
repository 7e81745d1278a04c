"""Headers and the C library of this installation, for programs in C and C++."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from pindrive import _core

_FOLDER: Final = Path(_core.__file__).parent
"""Folder of the extension, where headers and library are installed, also in an editable install."""
_LIBRARIES: Final = ("libpindrive.so", "libpindrive.dylib", "pindrive.dll")


def get_include() -> str:
    """Return the folder of the headers, for the option -I of a compiler.

    It has `pindrive.h` for C and `pindrive.hpp` for C++17.

    Returns:
        Path of the folder.
    """
    return str(_FOLDER / "include")


def get_library() -> str:
    """Return the path of the C library, to which `pindrive.h` belongs.

    Returns:
        Path of a shared library.

    Raises:
        FileNotFoundError: The installation has no C library. Wheels that are published have one; a
            build from source has one with the option `-Ccmake.define.PINDRIVE_C=ON` of pip.
    """
    folder = _FOLDER / "lib"
    for name in _LIBRARIES:
        if (folder / name).exists():
            return str(folder / name)
    raise FileNotFoundError(
        f"{folder}: this installation has no C library; "
        'build it with: python -m pip install "-Ccmake.define.PINDRIVE_C=ON" .'
    )
