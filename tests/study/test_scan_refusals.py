"""Studies of scans that cannot be: each is refused in one line that names the file and the key."""

from __future__ import annotations

from pathlib import Path

import pytest

from pindrive.files.overrides import ConfigError
from scan_studies import COILED, DEVICE, GRATING, study, swept


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


AXES = '[axes]\ncontrol.latency = ["1 ms"]\n'
WRONG = {
    ("page = 3\n" + AXES, ""): "page must be a table, [page], got 3",
    (AXES, "[page]\n"): "give exactly one of page.text, page.image and page.grating, got none of "
    "them",
    (AXES, '[page]\ntext = "A"\nimage = "a.png"\n'): "give exactly one of page.text, page.image "
    "and page.grating, got page.text and page.image",
    (AXES, '[page]\ntxt = "A"\n'): "unknown key page.txt; there are text, image, grating, font, "
    "path",
    (AXES, "[page]\ntext = 3\n"): "page.text must be text in quotes, got 3",
    (AXES, "[page]\ngrating = []\n"): 'page.grating must be a list of distances, like ["4 mm", '
    '"2 mm"], got []',
    (AXES, '[page]\ngrating = ["4 g"]\n'): "page.grating[0] must be in m or a unit alike, like "
    '"4 mm", got "4 g"',
    (AXES, '[page]\nimage = "none.png"\n'): "page.image: none.png cannot be read: No such file or "
    "directory",
    (AXES, '[page]\ntext = " "\n'): "page: text must be at least one character that is drawn, got "
    '" "',
    (
        AXES,
        '[page]\ngrating = ["4 mm"]\npath = "study.toml"\n',
    ): 'page: study.toml: the header must be like "time [s], x [m], y [m]"',
    (AXES, GRATING + 'font = "a.ttf"\n'): "page.font a.ttf: goes with page.text alone",
    ('[axes]\nmouse_velocity = ["1 mm/s"]\n', GRATING): "axes: motion.mouse_velocity has no part "
    "in a scan, in which the hand moves the mouse; leave out [page] to vary it",
    ('[tolerances]\nlatency = "5 %"\n', ""): "tolerances: control.latency acts in a scan; say what "
    'is on the page, as with grating = ["4 mm"] in [page]',
    ("[axes]\narray.columns = [1, 2.5]\n", GRATING): "axes: array.columns must be a whole number, "
    "got 2.5",
    (
        "[axes]\narray.columns = { uniform = [1, 3] }\n[sample]\ncount = 9\n",
        GRATING,
    ): "axes: array.columns counts pins; give a list of whole numbers",
    ("[axes]\narray.places = [1]\n", GRATING): "axes: array.places is no single number, it cannot "
    "be varied",
    ("[axes]\ncontrol.latency = []\n", GRATING): "axes.control.latency must be a list of at least "
    "one value, got []",
    ('[axes]\ncontrol.latncy = ["1 ms"]\n', GRATING): "axes: unknown key control.latncy; did you "
    "mean control.latency?",
    ('[axes]\ncontrol.latency = ["1 mm"]\n', GRATING): "axes.control.latency[0] must be in s or a "
    'unit alike, like "5 ms", got "1 mm"',
    ('outputs = ["settling_time"]\n' + AXES, GRATING): "outputs: unknown number settling_time; "
    "did you mean median_smear_time or worst_smear_time?",
    (
        AXES + '[specification]\nswing = "<= 1 mm"\n',
        GRATING,
    ): "specification: unknown number swing; ",
    ("[axes]\nmagnet.turns = [100, 200]\n", GRATING): "axes: magnet.turns must be given with "
    "pole_area, gap, wire_diameter, turn_length, supply_voltage, got turns alone",
}


@pytest.mark.parametrize("given", WRONG)
def test_refusals(given: tuple[str, str]) -> None:
    with pytest.raises(ConfigError) as error:
        study(*given)
    (line,) = error.value.problems
    assert line.startswith("study.toml: ")
    assert WRONG[given] in line


def test_a_magnet_is_varied_one_way() -> None:
    with pytest.raises(ConfigError, match=r"axes: magnet\.fall_time must be left out where turns"):
        study('[axes]\nmagnet.fall_time = ["1 ms"]\n', device=DEVICE + COILED)


def test_places_of_pins_leave_no_grid_to_vary() -> None:
    placed = DEVICE.replace('pitch = "3 mm"', 'places = [["0 mm", "0 mm"], ["3 mm", "0 mm"]]')
    with pytest.raises(
        ConfigError, match=r"axes: array\.places must be left out where columns, rows or pitch"
    ):
        study('[axes]\narray.pitch = ["2 mm"]\n', device=placed)
    data = swept(study('[axes]\ncontrol.latency = ["1 ms", "4 ms"]\n', device=placed))
    assert (data.lines_crossed == 8).all()
