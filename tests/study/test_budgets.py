"""Studies whose products, chunks, designs and draws no machine could hold."""

from __future__ import annotations

from pathlib import Path

import pytest

from command import GOOD, run
from pindrive.files.overrides import ConfigError
from pindrive.study.spec import load_study

pytestmark = pytest.mark.usefixtures("in_empty_folder")

AXES = "[axes]\nmass = { lin = ['1 g', '2 g'], count = COUNT }\n"
SECOND = "damping_ratio = { lin = [0.1, 0.2], count = COUNT }\n"
TOLERANCES = "[tolerances]\nmass = '5 %'\n"
MOST = 524288000000


def write(text: str) -> None:
    Path("device.toml").write_text(GOOD, encoding="utf-8")
    Path("study.toml").write_text(f"base = 'device.toml'\n{text}", encoding="utf-8")


def refused(text: str) -> str:
    write(text)
    with pytest.raises(ConfigError) as found:
        load_study("study.toml")
    (line,) = found.value.problems
    return line.removeprefix("study.toml: ")


@pytest.mark.parametrize("count", [10**12, 10**30])
def test_an_axis_of_too_many_values(count: int) -> None:
    assert refused(AXES.replace("COUNT", str(count))).startswith(
        f"axes.drive.mass.count must be a whole number from 2 to {MOST}, got 1"
    )


def test_a_product_of_axes() -> None:
    assert refused((AXES + SECOND).replace("COUNT", "1000000")) == (
        "the chunks of the study must be at most 1000000, got 15258790 (1000000000000 points, "
        "65536 in each; a larger chunk makes fewer)"
    )
    write("chunk = 524288\n" + (AXES + SECOND).replace("COUNT", "700000"))
    assert load_study("study.toml").size == 490_000_000_000  # for the disk to say


def test_disk_space_limits_the_points() -> None:
    write("chunk = 524288\n" + (AXES + SECOND).replace("COUNT", "700000"))
    said = run("sweep", "study.toml")
    assert said.exit_code == 2
    assert said.stderr.startswith("study.nc: needs ") and ", and the disk has " in said.stderr
    assert not Path("study.nc.partial").exists() and not Path("study.nc.journal").exists()


def test_chunks_are_as_large_as_memory_allows() -> None:
    axis = AXES.replace("COUNT", "3")
    assert refused("chunk = 524289\n" + axis) == (
        "chunk must be a whole number from 1 to 524288, got 524289"
    )
    page = "[page]\ngrating = ['4 mm']\n"
    assert refused("chunk = 4097\n" + axis + page) == (
        "chunk must be a whole number from 1 to 4096, got 4097"
    )


def test_counts_of_pins_are_not_listed_one_by_one_without_end() -> None:
    axis = "[axes]\narray.columns = { lin = [1, 1000], count = 1000000 }\n"
    assert refused(f"[page]\ngrating = ['4 mm']\n{axis}") == (
        "axes: the values of a key that counts pins must be at most 10000, got 1000000 "
        "(array.columns)"
    )


def test_limits_of_a_specification() -> None:
    many = ", ".join(["'<= 1 s'"] * 51)
    assert refused(f"{AXES.replace('COUNT', '3')}[specification]\nsettling_time = [{many}]\n") == (
        "the limits of the specification must be at most 50, got 51"
    )


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("sensitivity --rows 1073741824", "1073741824 rows of "),
        (f"sensitivity --rows {2**40}", "rows of "),
        ("robustness --draws 1000000000000", "1000000000000 draws of 1 keys and 3 results"),
    ],
)
def test_designs_that_are_kept_whole(command: str, words: str) -> None:
    write(AXES.replace("COUNT", "3") + TOLERANCES)
    name, *options = command.split()
    said = run(name, "study.toml", *options)
    assert said.exit_code == 2, said.output
    (line,) = said.stderr.splitlines()
    assert line.startswith("the numbers of the design must be at most 100000000, got ")
    assert words in line


def test_limits_have_a_size() -> None:
    study = f"{AXES.replace('COUNT', '3')}[specification]\nsettling_time = '<= 1e300 s'\n"
    assert refused(study) == (
        "specification.settling_time must be a finite limit, of at most 1e+100 in size, got "
        '"<= 1e300 s"'
    )
