"""Contents of a report as rows of cells."""

from __future__ import annotations

import re
from io import StringIO

from rich.console import Console, Group, RenderableType
from rich.table import Table


def printed(report: RenderableType) -> str:
    with StringIO() as shown:
        Console(file=shown, width=300).print(report)
        return shown.getvalue()


def table(report: RenderableType, title: str) -> list[list[str]]:
    """The rows of the table whose title begins so; the first are its headings."""
    assert isinstance(report, Group)
    (found,) = (
        part
        for part in report.renderables
        if isinstance(part, Table) and str(part.title).startswith(title)
    )
    columns = [[column.header, *column.cells] for column in found.columns]
    return [[str(cell).replace("\n", " ") for cell in row] for row in zip(*columns, strict=True)]


def numbers(text: str) -> list[float]:
    """All numbers in a text, in order."""
    return [float(found) for found in re.findall(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", text)]
