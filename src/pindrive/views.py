"""Views of results that later packages provide: their figures, their files, their evaluation.

A result does not import what draws or writes it. The package that does so names the function of
each method in its module `views`, which is loaded when the method is first called.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from pathlib import Path

    from pindrive.lazy import mpl_figure

__all__ = ["NotebookHtml", "csv_file", "evaluation", "figure"]

R = TypeVar("R")


class View(Generic[R]):
    """A kind of view of a result, by the name of the package that provides it."""

    def __init__(self, package: str) -> None:
        self._package = package

    def __call__(self, result: object, method: str, *given: Any) -> R:
        """Return the view that the package provides for a method of a result.

        Args:
            result: The result; its class or a base of it is listed in the package's `VIEWS`.
            method: The name of the method.
            *given: Further arguments of the function.
        """
        views = import_module(f"{self._package}.views").VIEWS
        names = (f"{base.__name__}.{method}" for base in type(result).__mro__)
        module, _, function = next(views[name] for name in names if name in views).partition(":")
        view: R = getattr(import_module(f"{self._package}.{module}"), function)(result, *given)
        return view


figure: View[mpl_figure.Figure] = View("pindrive.plot")
_html: View[str] = View("pindrive.plot")
csv_file: View[Path] = View("pindrive.files")
evaluation: View[Any] = View("pindrive.evaluation")


class NotebookHtml:
    """A result that a notebook shows as a table with units and a small picture."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        return _html(self, "_repr_html_")
