"""Studies of scans: each point is what `scan` and `evaluate` say of that device, to the bit."""

from __future__ import annotations

import json
from collections.abc import Mapping
from io import StringIO
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from PIL import Image
from rich.console import Console
from typer.testing import CliRunner, Result

from pindrive import Contact, Drive, Status
from pindrive.cli.app import app
from pindrive.cli.study_tables import sobol_report
from pindrive.device import Coil, ControlBlock, Criteria, Device, Electromagnet, PinArray, scan
from pindrive.device.coil import BY_SHEET
from pindrive.device.coil import COIL as MADE_OF
from pindrive.device.page_description import Page
from pindrive.device.reading import Reading
from pindrive.evaluation import Evaluation
from pindrive.evaluation import evaluate as evaluate_scan
from pindrive.files.keys import NUMERIC_KEYS
from pindrive.plot.sensitivity import plot_sobol_indices
from pindrive.plot.slices import plot_study
from pindrive.study.distributions import Sample
from pindrive.study.evaluate import evaluate
from pindrive.study.outputs import SCAN_OUTPUTS
from pindrive.study.robustness import robustness
from pindrive.study.runner import on_threads, sweep
from pindrive.study.sensitivity import sobol
from pindrive.study.slices import Slice
from pindrive.study.spec import load_study
from pindrive.study.workers import spread
from scan_studies import COILED, DEVICE, GRATING, study, swept

SHEET = """
[magnet]
hold_force = "1 N"
resistance = "25 ohm"
inductance = "25 mH"
supply_voltage = "5 V"
"""
AROUND = ("control", "array", "scan", "criteria")
REFUSED = Status.refused


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, list(arguments))


# ---- the oracle: the device put together by hand -------------------------------------------------

COIL = {
    "turns": 300.0,
    "pole_area": 6e-6,
    "gap": 6e-5,
    "wire_diameter": 1e-4,
    "turn_length": 0.016,
    "supply_voltage": 3.0,
}


def direct(at: dict[str, float], coiled: bool = False) -> Evaluation:
    """Return the results of `scan` and `evaluate` for the study's device with these values, SI."""
    tables: dict[str, dict[str, Any]] = {
        "drive": {"mass": 0.010, "stiffness": 100.0, "damping_ratio": 0.32},
        "plate": {"kinetic": 0.022},
        "finger": {"kinetic": 0.020, "stiffness": 300.0},
        "magnet": dict(COIL) if coiled else {},
        "control": {},
        "array": {"pitch": 0.003},
        "scan": {"hand_speed": 0.100, "pause": 0.050},
        "criteria": {},
    }
    for key, value in at.items():
        table, _, name = key.partition(".")
        tables[table][name] = value
    body = tables["drive"] | {
        "plate": Contact(**tables["plate"]),
        "finger": Contact(**tables["finger"]),
    }
    if "damping" in body:
        del body["damping_ratio"]
    magnet = tables["magnet"]
    made = {name: magnet.pop(name) for name in [*magnet] if name in COIL}
    device = Device(
        drive=Drive(**body),
        magnet=Electromagnet.from_coil(Coil(**made), **magnet)
        if made
        else Electromagnet.from_times(**magnet),
        control=ControlBlock(**tables["control"]),
        array=PinArray.grid(**tables["array"]),
    )
    reading = Reading(**tables["scan"])
    scene = reading.grating([0.004], device.array)
    return evaluate_scan(
        scan(device, scene, reading.strokes(scene, device.array)), Criteria(**tables["criteria"])
    )


def numbers(evaluation: Evaluation) -> dict[str, float]:
    """Some of each kind, counted and sorted out anew."""
    shown = [line for line in evaluation.lines if line.fate == "shown"]
    found: dict[str, float] = {
        "lines_crossed": len(evaluation.lines),
        "lines_shown": len(shown),
        "lines_shown_part": len(shown) / len(evaluation.lines),
        "lines_merged": sum(line.fate == "merged" for line in evaluation.lines),
        "lines_false": len(evaluation.false_lines),
        "lines_unsettled": sum(line.settled != line.settled for line in shown),
        "lines_direction": sum(line.begin.cue in ("direction", "sure") for line in shown),
        "hand_duration": evaluation.scan.path.end - evaluation.scan.path.begin,
    }
    for name, values, worst in (
        ("latency_on", [line.begin.response - line.begin.time for line in shown], max),
        ("lag_off", [line.end.lag for line in shown], max),
        ("stroke", [line.stroke for line in shown], min),
        ("smear", [line.smear for line in shown], max),
        ("contrast", [line.contrast for line in shown], min),
        ("skin_on", [line.begin.skin for line in shown], min),
    ):
        known = sorted(value for value in values if value == value)
        half = len(known) // 2
        middle = known[half] if len(known) % 2 else 0.5 * sum(known[half - 1 : half + 1] or [nan])
        found[f"median_{name}"] = middle if known else nan
        found[f"worst_{name}"] = worst(known) if known else nan
    return found


def assert_same(point: Mapping[Any, Any], evaluation: Evaluation) -> None:
    assert point["status"] == 0
    for name, value in numbers(evaluation).items():
        np.testing.assert_array_equal(point[name], value, err_msg=name)


# ---- points --------------------------------------------------------------------------------------

VARIED = {
    "drive.mass": (["5 g", "12 g"], [0.005, 0.012]),
    "drive.damping": (["0.2 N*s/m", "0.9 N*s/m"], [0.2, 0.9]),
    "drive.damping_ratio": ([0.05, 0.7], [0.05, 0.7]),
    "plate.kinetic": (["15 mN", "30 mN"], [0.015, 0.030]),
    "finger.kinetic": (["3 mN", "45 mN"], [0.003, 0.045]),
    "finger.stiffness": (["150 N/m", "800 N/m"], [150.0, 800.0]),
    "magnet.hold_force": (["0.4 N", "5 N"], [0.4, 5.0]),
    "magnet.fall_time": (["2 ms", "30 ms"], [0.002, 0.030]),
    "control.latency": (["0 ms", "13 ms"], [0.0, 0.013]),
    "control.sample_rate": (["300 Hz", "2.5 kHz"], [300.0, 2500.0]),
    "control.threshold": ([0.2, 0.8], [0.2, 0.8]),
    "array.columns": ([1, 3], [1.0, 3.0]),
    "array.axis": (["0 deg", "0.1 rad"], [0.0, 0.1]),
    "scan.hand_speed": (["40 mm/s", "150 mm/s"], [0.040, 0.150]),
    "scan.pause": (["0 ms", "80 ms"], [0.0, 0.080]),
    "criteria.felt": (["0.01 mm", "0.3 mm"], [1e-5, 3e-4]),
    "criteria.false_line": ([0.02, 1], [0.02, 1.0]),
}


@pytest.mark.parametrize("key", VARIED)
def test_a_point_is_a_scan_to_the_bit(key: str) -> None:
    written, values = VARIED[key]
    plan = study(f"[axes]\n{key} = {json.dumps(written)}\n")
    columns = plan.columns(0, 2)
    assert {k: v.tolist() for k, v in columns.items()} == {key: values}
    found = evaluate(plan, columns, 2, SCAN_OUTPUTS)
    evaluated = [direct({key: value}) for value in values]
    for i, evaluation in enumerate(evaluated):
        assert_same({name: column[i] for name, column in found.items()}, evaluation)
    one, other = (
        [numbers(j), [line.height for line in j.lines], j.scan.path.end] for j in evaluated
    )
    assert repr(one) != repr(other), "the key does something"


def test_products_links_and_draws() -> None:
    """A drawn key, a grid and a follower at once."""
    data = swept(
        study(
            """
            [axes]
            control.latency = { uniform = ["1 ms", "9 ms"] }
            finger.kinetic = ["10 mN", "40 mN"]
            plate.kinetic = { times = 1.5, of = "finger.kinetic" }
            [sample]
            count = 3
            """
        )
    )
    assert data.median_smear.dims == ("sample", "finger_kinetic")
    for i in range(3):
        for j, finger in enumerate((0.010, 0.040)):
            at = data.isel(sample=i, finger_kinetic=j)
            given = {"control.latency": float(at.latency), "finger.kinetic": finger}
            assert_same(at, direct(given | {"plate.kinetic": 1.5 * finger}))


def test_a_coil_may_be_varied() -> None:
    data = swept(study("[axes]\nmagnet.turns = [200, 320]\n", device=DEVICE + COILED))
    for i, turns in enumerate((200.0, 320.0)):
        evaluated = direct({"magnet.turns": turns}, coiled=True)
        assert_same(data.isel(turns=i), evaluated)
        # 430 K/W, and 3 V on copper of so many turns
        power = 9.0 / (turns * 0.016 / (58e6 * np.pi / 4.0 * 1e-8))
        on = sum(end - begin for begin, end in evaluated.scan.pins[0].energised)
        part = on / (evaluated.scan.path.end - evaluated.scan.path.begin)
        assert data.magnet_on_part[i] == pytest.approx(part, rel=1e-12)
        assert data.coil_warming[i] == pytest.approx(430.0 * power * part, rel=1e-12)
    assert "gap" in data.coords
    assert "hold_force" not in data.coords, "it changes with the turns"


PULSED = '\n[magnet]\npwm_frequency = "1 kHz"\npwm_duty = 0.5\n'
BY_COEFFICIENT = DEVICE.replace('kinetic = "22 mN"', "coefficient = 0.2").replace(
    'kinetic = "20 mN"', 'coefficient = 0.4\ntouch_force = "50 mN"'
)


STOPPED = DEVICE.replace(
    'mass = "10 g"', 'mass = "10 g"\ntravel = "5 mm"\nstop_stiffness = "100 kN/m"'
)
OPENING = 'lift = "0.05 mm"\nclosing_force = "20 mN"\n'


LAW_KEYS = [
    f"{table}.{name}"
    for table in ("plate", "finger")
    for name in ("law", "breakaway", "stribeck_velocity", "exponent", "breakaway_coefficient")
]


def falling(table: str, key: str) -> str:
    """The device with friction that falls at a contact."""
    coefficient = "coefficient" in key
    rest = "breakaway_coefficient = 0.5" if coefficient else 'breakaway = "40 mN"'
    lines = {"law": 'law = "stribeck"', rest.partition(" ")[0]: rest}
    lines |= {"stribeck_velocity": 'stribeck_velocity = "30 mm/s"'}
    device = BY_COEFFICIENT if coefficient else DEVICE
    if table == "finger":
        device = device.replace('stiffness = "300 N/m"\n', "")
    return device.replace(f"[{table}]\n", f"[{table}]\n" + "\n".join(lines.values()) + "\n")


@pytest.mark.parametrize("table", ["drive", "plate", "finger", "magnet", *AROUND])
def test_every_number_of_the_device_file_may_be_varied(table: str) -> None:
    """At a usual value and at another there is a scan."""
    for key, quantity in NUMERIC_KEYS.items():
        if not key.startswith(f"{table}.") or not quantity.may_be_constant:
            continue
        base = quantity.default or quantity.example or 0.01
        if key.endswith((".static", ".breakaway")):
            base = 0.040
        if key.endswith("breakaway_coefficient"):
            base = 0.60
        other = 2.0 if quantity.choices else 0.99 * base
        if key in ("array.columns", "array.rows") or key.endswith(".exponent"):
            other = base + 1.0
        coiled = COILED if quantity.name in MADE_OF else ""
        if quantity.name in BY_SHEET:
            coiled = SHEET
        if quantity.name in ("lift", "closing_force"):
            coiled += OPENING
        plan = study(
            f"[axes]\n{key} = {json.dumps([quantity.written(x) for x in (base, other)])}\n",
            device=(
                falling(table, key)
                if key in LAW_KEYS
                else BY_COEFFICIENT
                if "coefficient" in key or "touch" in key
                else STOPPED
                if key.startswith("drive.stop_")
                else DEVICE + (coiled or (PULSED if "pwm" in key else ""))
            ),
        )
        found = evaluate(plan, plan.columns(0, 2), 2, SCAN_OUTPUTS)
        assert (found["status"] == 0).all(), key
        assert (found["lines_crossed"] > 0).all(), key


def test_a_point_without_a_scan_is_marked() -> None:
    """A band of the control block that leaves 0 to 1, and a coil without a field."""
    plan = study("[axes]\ncontrol.threshold = [0.02, 0.5]\nhysteresis = [0.01, 0.1]\n")
    said = run("sweep", "study.toml", "--threads", "1")
    assert said.exit_code == 0, said.output
    assert said.stdout.splitlines()[1:] == [
        "without numbers: 25 %, by their status",
        "  25 % refused: control.hysteresis must be at most 0.04 about a threshold of 0.02, "
        "got 0.1",
    ]
    with xr.open_dataset("study.nc") as data:
        np.testing.assert_array_equal(data.status, [[0, REFUSED], [0, 0]])
        assert "coil_warming" not in data, "no coil is described"
        bad = data.isel(threshold=0, hysteresis=1)
        assert all(np.isnan(bad[name]) for name in data.data_vars if name != "status")
        assert data.lines_crossed.notnull().sum() == 3
    assert plan.size == 4


# ---- the file ------------------------------------------------------------------------------------

GRID = """
chunk = 4
outputs = ["shown_part", "false", "smear", "worst_smear", "lines.crossed", "duration"]
[axes]
scan.hand_speed = { lin = ["80 mm/s", "200 mm/s"], count = 6 }
control.latency = ["1 ms", "4 ms", "7 ms", "10 ms"]
"""


def test_file_has_all_results() -> None:
    data = swept(study('name = "lines"\n' + GRID))
    assert data.attrs["page"] == "lines every 4 mm"
    assert 'grating = ["4 mm"]' in data.attrs["study"]
    assert {*data.data_vars} == {
        *("lines_shown_part", "lines_false", "median_smear", "worst_smear"),
        *("lines_crossed", "hand_duration", "status"),
    }
    assert data.latency.attrs["units"] == "s"
    assert data.median_smear.attrs["long_name"].startswith("median of the lines shown: path of the")
    assert data.worst_smear.attrs["units"] == "m"
    assert data.felt == 45e-6
    assert "mouse_velocity" not in data.coords, "it has no part in a scan"


def test_stopped_and_resumed_is_the_same_file() -> None:
    plan = study(GRID)
    sweep(plan, Path("whole.nc"), work=on_threads(1))
    first = run("sweep", "study.toml", "--stop-after", "9", "--threads", "1")
    assert "Stopped at 12 of 24 points" in first.stdout
    done = run("sweep", "study.toml", "--resume", "--threads", "1")
    assert "24 points, 12 of them now" in done.stdout
    assert Path("study.nc").read_bytes() == Path("whole.nc").read_bytes()


def test_threads_change_nothing() -> None:
    plan = study(GRID)
    sweep(plan, Path("whole.nc"), work=on_threads(1))
    sweep(plan, Path("study.nc"), work=on_threads(2))
    assert Path("study.nc").read_bytes() == Path("whole.nc").read_bytes()
    columns = plan.columns(0, plan.size)
    one, two = (evaluate(plan, columns, plan.size, SCAN_OUTPUTS, threads) for threads in (1, 2))
    for name, values in one.items():
        np.testing.assert_array_equal(values, two[name], err_msg=name)


def picture(name: str, dark: slice) -> None:
    """A page of 20 mm by 4 mm with an upright line."""
    pixels = np.full((40, 200), 255, np.uint8)
    pixels[:, dark] = 0
    Image.fromarray(pixels).save(name, dpi=(254, 254))


def test_page_has_the_options_of_its_scan() -> None:
    """As `pindrive scan` takes it, which a worst case tells to do."""
    assert Page(grating=(0.004, 0.0025)).options == '--grating "4 mm, 2.5 mm"'
    page = Page(text="A\nb", font=Path("a.ttf"), path=Path("hand.csv"))
    assert page.options == '--text "A\\nb" --font "a.ttf" --path "hand.csv"'
    assert page.words == 'text "A / b" along hand.csv'


def test_the_identity_holds_the_page() -> None:
    axes = '[axes]\ncontrol.latency = ["1 ms"]\n'
    grating = study(axes).identity()
    assert study(axes).identity() == grating
    assert study(axes, GRATING.replace("4 mm", "3 mm")).identity() != grating
    assert study(axes, device=DEVICE + "[criteria]\nfalse_line = 0.6\n").identity() != grating
    assert study(axes, '[page]\ntext = "4"\n').identity() != grating
    Path("hand.csv").write_text("time [s], x [mm], y [mm]\n0, 2, 2\n1, 18, 2\n")
    page = '[page]\nimage = "page.png"\npath = "hand.csv"\n'
    picture("page.png", slice(80, 100))
    before = study(axes, page).identity()
    picture("page.png", slice(80, 110))
    assert study(axes, page).identity() != before
    picture("page.png", slice(80, 100))
    assert study(axes, page).identity() == before
    Path("hand.csv").write_text("time [s], x [mm], y [mm]\n0, 2, 2\n1, 17, 2\n")
    assert study(axes, page).identity() != before


def test_a_page_that_changes_meanwhile_is_refused() -> None:
    """No point is computed from a changed picture."""
    picture("page.png", slice(80, 100))
    plan = study('[axes]\ncontrol.latency = ["1 ms"]\n', '[page]\nimage = "page.png"\n')
    picture("page.png", slice(80, 110))
    with pytest.raises(ValueError, match=r"page\.image: page\.png has changed since the study"):
        sweep(plan, Path("study.nc"), work=on_threads(1))
    assert not Path("study.nc").exists()
    axes, page = '[axes]\ncontrol.latency = ["1 ms"]\n', '[page]\nimage = "page.png"\n'
    broad = swept(study(axes, page), "broad.nc")
    picture("page.png", slice(80, 100))
    assert swept(study(axes, page), "narrow.nc").median_latency_off != broad.median_latency_off


# ---- what studies are for ------------------------------------------------------------------------

ONE_LINE = '[page]\nimage = "page.png"\n'
TOLERANCES = """
[tolerances]
scan.hand_speed = { uniform = ["150 mm/s", "200 mm/s"] }
control.latency = { uniform = ["0 ms", "10 ms"] }
[specification]
duration = "<= 0.2 s"
lag_on = "<= 2 mm"
"""


def test_robustness_is_that_of_scans() -> None:
    """Equal draws by hand; the longest path belongs to the slowest hand: 1.875 L / v + pause."""
    picture("page.png", slice(80, 100))
    plan = study(TOLERANCES, ONE_LINE)
    found = robustness(plan, count=40, threads=1)
    portions = Sample(tuple(plan.tolerances), 40, 1).parts(np.arange(40))
    speeds = 0.150 + 0.050 * portions[0]
    times = 1.875 * 0.020 / speeds + 0.050
    np.testing.assert_allclose(found.values["hand_duration"], times, rtol=1e-12)
    assert found.shares[0][1].met == (times <= 0.2).sum()
    assert len(found.refusals) == 0
    longest, farthest = found.worst
    assert longest.value == pytest.approx(1.875 * 0.020 / 0.150 + 0.050, rel=1e-3)
    assert farthest.keys["scan.hand_speed"] == pytest.approx(0.200, rel=0.02)
    assert farthest.keys["control.latency"] == pytest.approx(0.010, rel=0.05)
    assert farthest.value >= farthest.sampled > 0.0
    assert found.own["lines_shown_part"] == 1.0
    study(TOLERANCES.partition("[specification]")[0], ONE_LINE)
    said = run("robustness", "study.toml", "--draws", "5", "--threads", "1", "--plot", "a.png")
    assert said.exit_code == 0, said.output
    assert "shown_part" in said.stdout and Path("a.png").stat().st_size > 10_000


def test_sobol_indices_are_those_of_scans() -> None:
    """The duration depends on the hand's speed alone; a pin's response on both keys."""
    picture("page.png", slice(80, 100))
    plan = study(TOLERANCES, ONE_LINE)
    found = sobol(plan, tolerances=True, rows=128, threads=1, near=True)
    assert found.near is None
    assert found.points == 512 and len(found.refusals) == 0
    time = found.over["hand_duration"].total
    np.testing.assert_allclose(time.value, [1.0, 0.0], atol=0.15)
    assert time.value[1] == 0.0
    latency = found.over["median_latency_on"].total.value
    assert latency[1] > 0.9 > latency[0]
    assert found.over["lines_crossed"].spread == 0.0
    with StringIO() as shown:
        Console(file=shown, width=200).print(sobol_report(found))
        said = shown.getvalue()
    assert "No elasticities: a scan has no exact derivatives." in said
    assert "Near the device" not in said
    figure = plot_sobol_indices(found, "a study")
    assert [axes.get_title() for axes in figure.axes] == [
        "over the ranges: part of the variance due to"
    ]


def test_counts_have_no_sensitivity() -> None:
    plan = study("[axes]\narray.columns = [1, 2]\n")
    with pytest.raises(ValueError, match=r"axes\.array\.columns counts pins, and there is nothing"):
        sobol(plan, near=True)


def test_nothing_varied_has_no_sensitivity() -> None:
    study("")
    said = run("sensitivity", "study.toml")
    assert (said.exit_code, said.stdout) == (2, "")
    assert said.stderr == "study.toml: nothing varies; write what in [axes] or [tolerances]\n"


def test_maps_show_the_file() -> None:
    data = swept(study(GRID))
    with Slice("study.nc") as view:
        assert view.usual_numbers() == ["lines_shown_part"]
        assert view.number("shown_part") == "lines_shown_part"
        assert view.number("smear") == "median_smear"
        (panel,) = view.panels("median_smear", "hand_speed", "latency", {})
        np.testing.assert_array_equal(panel.values, data.median_smear.T)
        figure = plot_study(view, ["median_smear"], "hand_speed", "latency", {})
        title = figure.get_suptitle()
        assert "lines every 4 mm" in title and "damping" not in title
        assert r"$v_\mathrm{h}$ (mm/s)" in figure.axes[0].get_xlabel()
        with pytest.raises(ValueError, match="unknown number"):
            view.number("settling_time")
    said = run("map", "study.nc", "--plot", "m.png", "--x", "latency", "--at", "hand_speed=80 mm/s")
    assert said.exit_code == 0, said.output


def test_releases_of_a_whole_device_are_swept_too() -> None:
    """Without a page, what stands around the drive has no part."""
    device = DEVICE + "[criteria]\nfalse_line = 0.6\n"
    data = swept(study('[axes]\nmass = ["5 g", "10 g"]\n', "", device))
    assert (data.status == 0).all()
    assert "false_line" not in data.coords


def test_the_example_is_a_study_of_scans() -> None:
    """The first points of the study in docs/studies.md, one point built by hand."""
    file = Path(__file__).parents[2] / "examples" / "tactile-reader-study.toml"
    plan = load_study(file)
    assert plan.shape == (19, 13, 3)
    begin = next(n for n in range(plan.size) if plan.columns(n, n + 1)["scan.hand_speed"] > 0.149)
    columns = plan.columns(begin, begin + 2)
    found = evaluate(plan, columns, 2, SCAN_OUTPUTS)
    assert (found["status"] == 0).all()
    drive = Drive(
        mass=0.001,
        stiffness=250.0,
        damping_ratio=0.5,
        plate=Contact(coefficient=0.225, static_coefficient=0.27),
        finger=Contact(coefficient=0.5, static_coefficient=0.75, stiffness=300.0, damping=0.3),
        touch_force=columns["finger.touch_force"][1],
    )
    magnet = Electromagnet.from_times(fall_time=columns["magnet.fall_time"][1])
    device = Device(drive=drive, magnet=magnet)
    reading = Reading(hand_speed=columns["scan.hand_speed"][1])
    scene = reading.grating([0.004, 0.002, 0.001], device.array)
    evaluated = evaluate_scan(scan(device, scene, reading.strokes(scene, device.array)))
    for name, value in numbers(evaluated).items():
        assert found[name][1] == value, name


def test_portions_are_spread_in_order_and_may_be_none() -> None:
    assert spread(pow, 2, [3, 1, 2], 2) == [8, 2, 4]
    assert spread(pow, 2, [], 2) == []
