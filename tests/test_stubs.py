"""The committed stub of the extension, which type checkers read, says what the extension holds."""

import ast
from importlib.resources import files

from tasks.checks import STUB


def declarations(text: str) -> str:
    return ast.dump(ast.parse(text), indent=1)


def test_the_committed_stub_is_up_to_date() -> None:
    built = files("pindrive").joinpath("_core.pyi").read_text("utf-8")
    assert declarations(STUB.read_text("utf-8")) == declarations(built), (
        "src/pindrive/_core.pyi is out of date: refresh it with `python3 run.py stubs`"
    )


def test_package_is_marked_as_typed() -> None:
    assert files("pindrive").joinpath("py.typed").is_file()
