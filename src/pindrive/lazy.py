"""Imports at first use: the one place where the import of a module of this package is postponed.

A package hands out its public names by `attach`; a result reaches what is built on it, such as its
figure, by `call`. The targets are text, so that the graph of the import statements has no circle.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def attach(
    package: str, homes: Mapping[str, str]
) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """The functions `__getattr__` and `__dir__` of a package whose names are imported at first use.

    Args:
        package: its name.
        homes: the module of each public name.
    """

    def get(name: str) -> object:
        if name == "__version__":
            from importlib.metadata import version

            value: object = version(package)
        elif name in homes:
            value = getattr(import_module(homes[name]), name)
        else:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        vars(sys.modules[package])[name] = value
        return value

    return get, lambda: sorted(sys.modules[package].__all__)


def call(target: str, *arguments: Any) -> Any:
    """The result of a function or class that is named as "module:name"."""
    module, _, name = target.partition(":")
    return getattr(import_module(module), name)(*arguments)
