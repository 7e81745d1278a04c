"""The parts of the reference pages that are made of pindrive itself, to be read in a checkout.

`python docs/_ext/reference.py` writes them anew, each between two comments that name its part.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from importlib import import_module
from inspect import getdoc
from pathlib import Path
from typing import Any, Final

import c_header
from typer.main import get_command
from typer.testing import CliRunner

from pindrive.cli.app import app
from pindrive.files.keys import FILE_KEYS, usual_function
from pindrive.files.keys import template as device_template
from pindrive.quantities.functions import FUNCTIONS, FUNCTIONS_OF
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.results import DESIGNED, LINE, LINE_COUNTS, OUTPUTS, SCANNED, SERIES
from pindrive.quantities.status import End, Status
from pindrive.study.template import study_template


def table(headings: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table in Markdown."""
    headings = list(headings)
    lines = [headings, ["---"] * len(headings)]
    lines += [[cell.replace("|", "\\|").replace("*", "\\*") for cell in row] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def code(text: str, language: str) -> str:
    """A block of code."""
    return f"```{language}\n{text.rstrip()}\n```"


def commands() -> str:
    """The help of each command, as it prints it."""
    parts = []
    program: Any = get_command(app)
    for name in program.list_commands(None):
        said = CliRunner().invoke(app, [name, "--help"], env={"COLUMNS": "80"})
        if said.exit_code:
            raise RuntimeError(f"pindrive {name} --help ends with {said.exit_code}")
        parts += [f"## {name}", code(said.stdout, "text")]
    return "\n\n".join(parts)


def device_file() -> str:
    """Each key of a device file, by its table."""
    groups: dict[str, list[Quantity]] = {}
    for key, quantity in FILE_KEYS.items():
        groups.setdefault(key.partition(".")[0], []).append(quantity)
    headings = ("key", "unit", "meaning", "values", "unless given", "source")
    parts = []
    for name, quantities in groups.items():
        rows = (
            (
                f"`{q.key}`",
                q.unit,
                q.meaning,
                "; ".join(filter(None, (q.bounds.words(""), q.remark))),
                "must be given"
                if q.mandatory
                else "-"
                if q.absent is None
                else q.written(q.absent),
                q.source,
            )
            for q in quantities
        )
        parts += [f"## `[{name}]`", table(headings, rows)]
    parts += ["## Inputs as functions of time", functions_of_time()]
    parts += ["## The file that `pindrive init --device` writes"]
    parts += [code(device_template(whole=True), "toml")]
    return "\n\n".join(parts)


_FORMULAS = {
    "harmonic": "A sinusoid, mean + amplitude · sin(2π · frequency · t + phase):",
    "minimum_jerk": "The velocity of a stroke of minimum jerk, zero before and after:",
    "exponential": "An exponential, end + (start − end) e^(−(t − begin)/time_constant), and start "
    "before its begin:",
}


def functions_of_time() -> str:
    """The functions that an input of [motion] may be, with their parameters."""
    inputs = ", ".join(f"`{name}`" for name in FUNCTIONS_OF)
    speed = FILE_KEYS["motion.mouse_velocity"]
    parts = [
        f"{inputs} may be a table of parameters, or a list of such tables, which are added. Each "
        "parameter is a key of its own: `motion.mouse_velocity.amplitude` in an override, a study "
        "or a fit."
    ]
    for kind, parameters in FUNCTIONS.items():
        rows = (
            (
                f"`{q.name}`",
                q.unit or "that of the input",
                q.meaning,
                q.bounds.words(""),
                "must be given" if q.absent is None else q.written(q.absent),
            )
            for q in parameters
        )
        example = f"mouse_velocity = {usual_function(speed, kind)}"
        parts += [_FORMULAS[kind], code(example, "toml")]
        parts += [table(("parameter", "unit", "meaning", "values", "unless given"), rows)]
    parts.append(
        "Any function of pieces, as `pindrive.Function` has it, in SI numbers, each term with "
        "cosine, sine, decay and frequency (rad/s):"
    )
    pieces = '{ begin = "0 s", polynomial = [0.06, 0.1], terms = [[0, 0.01, 0, 50]] }'
    parts.append(code(f"mouse_velocity = {{ pieces = [{pieces}] }}", "toml"))
    return "\n\n".join(parts)


def study_file() -> str:
    """The study file that is written, with its comments."""
    return code(study_template(), "toml")


def dataset() -> str:
    """The variables of datasets: over time, and the numbers of motions and scans."""

    def rows(quantities: Iterable[Quantity]) -> Iterable[tuple[str, ...]]:
        return ((f"`{q.name.replace('.', '_')}`", q.unit, q.meaning, q.source) for q in quantities)

    headings = ("variable", "unit", "meaning", "source")
    groups = {
        "Over time": SERIES.values(),
        "Numbers of a motion": OUTPUTS,
        "Of the pins of a scan": SCANNED,
        "Of the lines that were read": LINE,
        "Counts of the evaluation": LINE_COUNTS,
        "Of a design": DESIGNED,
    }
    return "\n\n".join(f"## {name}\n\n{table(headings, rows(of))}" for name, of in groups.items())


def status() -> str:
    """The codes of how far a motion was followed, and of how it ends."""
    codes = ((f"`{s.name}`", str(s.value), s.explanation) for s in Status)
    ends = ((f"`{end.name}`", str(end.value)) for end in End)
    first = table(("status", "code", "meaning"), codes)
    return f"## Status\n\n{first}\n\n## Endings\n\n{table(('ending', 'code'), ends)}"


def python() -> str:
    """Return the description of each public name, by the module that has it."""
    page = (PAGES / "python.md").read_text("utf-8")
    module, groups = "", dict[str, list[tuple[str, str]]]()
    for kind, name in re.findall(r"^\.\. (currentmodule|auto\w+):: ([\w.]+)$", page, re.M):
        if kind == "currentmodule":
            module = name
        else:
            said = getdoc(getattr(import_module(module), name)) or ""
            groups.setdefault(module, []).append((f"`{name}`", said.partition("\n")[0]))
    return "\n\n".join(table((f"`{of}`", ""), names) for of, names in groups.items())


def problem_file() -> str:
    """An example of a design problem."""
    return code((EXAMPLES / "tactile-mouse-problem.toml").read_text("utf-8"), "toml")


PAGES: Final = Path(__file__).parents[1] / "reference"
EXAMPLES: Final = Path(__file__).parents[2] / "examples"
PARTS: Final[dict[str, Callable[[], str]]] = {
    "commands": commands,
    "device-file": device_file,
    "study-file": study_file,
    "problem-file": problem_file,
    "dataset": dataset,
    "python": python,
    "status": status,
    "c-header": c_header.reference,
}


def whole(page: str) -> str:
    """A page with its parts made anew."""

    def made(found: re.Match[str]) -> str:
        return f"{found[1]}\n\n{PARTS[found[2]]()}\n\n{found[3]}"

    begin, end = r"(<!-- made of pindrive: (\S+) -->)", "(<!-- end -->)"
    return re.sub(f"{begin}.*?{end}", made, page, flags=re.DOTALL)


def main() -> None:
    """Write the pages that have changed."""
    for path in sorted(PAGES.glob("*.md")):
        text = path.read_text("utf-8")
        if (now := whole(text)) != text:
            path.write_text(now, "utf-8")
            print(f"Wrote {path}")


if __name__ == "__main__":
    main()
