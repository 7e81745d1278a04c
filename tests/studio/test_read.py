"""The view "Read": a hand in the page has the bits of `scan`, at any rate of pictures."""

from __future__ import annotations

import base64
import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from typer.testing import CliRunner

import pindrive as pd
from cases import cases
from pindrive.cli.app import app
from pindrive.files.reading import PLACES, load_reading
from studio_cases import Ask, doubles

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
READER = (EXAMPLES / "tactile-reader.toml").read_text("utf-8")
RIGID = READER.replace('stiffness = "300 N/m"\n', "").replace('damping = "0.3 N*s/m"\n', "")
TURNED = READER.replace("spot_scale = 0.5\n", 'spot_scale = 0.5\naxis = "20 deg"\n')
PIXEL = 1e-3 / 22


def page_of_lines() -> np.ndarray[Any, np.dtype[np.uint8]]:
    grey = np.full((275, 968), 255, np.uint8)
    for left in range(200, 700, 90):
        grey[30:240, left : left + 40] = 0
    grey[100:130, 500:900] = 60
    return grey


def followed(node: Ask, slowness: int, straight: bool, seed: int) -> dict[str, Any]:
    """A hand that follows a shaky pointer across the page."""
    random = np.random.default_rng(seed)
    count = {40: 2400, 10: 900, 1: 90}[slowness]
    x = np.linspace(0.004, 0.040, count) + random.normal(0.0, 2e-5, count)
    y = 0.00625 + 1e-4 * np.sin(np.arange(count) / 40) + random.normal(0.0, 2e-5, count)
    aims = [{"x": a, "y": b} for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    (hand,) = node([{"follow": {"slowness": slowness, "straight": straight, "aims": aims}}])
    return dict(hand)


def saved(hand: dict[str, Any], device: str, path: Path) -> Path:
    """The reading as the page saves it."""
    grey = page_of_lines()
    deflate = zlib.compressobj(wbits=-zlib.MAX_WBITS)
    packed = deflate.compress(grey.tobytes()) + deflate.flush()
    page = {
        "title": "lines",
        "rows": grey.shape[0],
        "columns": grey.shape[1],
        "pixel": PIXEL,
        "luminance": base64.b64encode(packed).decode(),
    }
    reading = {"format": "pindrive reading 1", "device": device, "page": page, "hand": hand}
    path.write_text(json.dumps(reading), "utf-8")
    return path


def asked(hand: dict[str, Any], device: str, pictures: list[float]) -> dict[str, Any]:
    grey = page_of_lines()
    page = {
        "grey": base64.b64encode(grey.tobytes()).decode(),
        "rows": grey.shape[0],
        "columns": grey.shape[1],
    }
    return {
        "read": {
            "device": device,
            "page": page,
            "pixel": PIXEL,
            "hand": hand,
            "pictures": pictures,
        }
    }


def pictures(end: float, rate: float, seed: int) -> list[float]:
    """Times of pictures at a rate that varies, up to the end."""
    random = np.random.default_rng(seed)
    times = np.cumsum(random.uniform(0.2, 1.8, int(2 * end * rate) + 4) / rate)
    return [*times[times < end].tolist(), end]


@pytest.mark.parametrize(
    ("slowness", "straight", "device"),
    [
        (10, True, READER),
        (10, False, READER),
        (1, True, READER),
        (40, False, RIGID),
        (10, True, TURNED),
    ],
    ids=["along a ruler", "free", "real time", "rigid, slow", "turned"],
)
def test_a_hand_has_the_bits_of_a_scan_at_any_rate_of_pictures(
    node: Ask, tmp_path: Path, slowness: int, straight: bool, device: str
) -> None:
    hand = followed(node, slowness, straight, 7)
    end = hand["rows"][-1][0] / 5000
    rates = [300.0, 17.0, 1e4]
    requested = [asked(hand, device, pictures(end, rate, i)) for i, rate in enumerate(rates)]
    found = node(requested)
    for other in found[1:]:
        assert {**other, "sampled": None} == {**found[0], "sampled": None}
    reading = load_reading(saved(hand, device, tmp_path / "reading.json"))
    done = pd.scan(reading.device, reading.page, reading.hand)
    pins = len(done.pins)
    position, stretch, force, _, command, luminance = np.reshape(
        doubles(found[0]["end"]), (6, pins)
    )
    assert_allclose(force.sum(), done.force_on_hand(end), rtol=1e-9, atol=1e-12)
    # The end is no event: a series may be evaluated there from another step.
    assert_allclose(position, [pin.state.position for pin in done.pins], rtol=0.0, atol=1e-17)
    last = [pin.motion.stretch(end) for pin in done.pins]
    found_stretch = stretch if np.isfinite(stretch).all() else np.zeros(pins)
    assert_allclose(found_stretch, last, rtol=0.0, atol=1e-17)
    assert_array_equal(luminance, [pin_luminance(done, pin, end) for pin in range(pins)])
    assert np.ptp(luminance) > 0.5 and np.ptp(command) == 1.0
    evaluation = done.evaluate()
    printed = [line for line in found[0]["lines"] if line["outcome"] != "false"]
    false = [line for line in found[0]["lines"] if line["outcome"] == "false"]
    assert len(printed) == len(evaluation.lines) > 20
    assert [(line["pin"], line["time"]) for line in false] == [
        (swing.pin, pytest.approx(swing.time, rel=1e-12)) for swing in evaluation.false_lines
    ]
    for line, expected in zip(printed, evaluation.lines, strict=True):
        assert (line["pin"], line["outcome"]) == (expected.pin, expected.fate)
        assert line["time"] == expected.begin.time
        # The page finds a motion under functions by series, a scan in closed form.
        lag = np.nan if line["lag"] is None else line["lag"]
        assert lag == pytest.approx(expected.begin.lag, rel=1e-12, abs=1e-17, nan_ok=True)


ARM = {"mass": 0.55, "stiffness": 135.0, "damping": 6.5}
UNITS = ("kg", "N/m", "N*s/m")


@pytest.mark.parametrize(("slowness", "black"), [(40, 40), (10, 40), (10, 0), (1, 0)])
def test_a_hand_that_gives_way_moves_as_python_has_it(
    node: Ask, tmp_path: Path, slowness: int, black: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The page takes the force of the pins as even over 0.4 ms; `scan` follows the hand exactly.

    The page has one line, or none: with several a sample may fall on the other side of an edge.
    """
    grey = np.full((275, 968), 255, np.uint8)
    grey[:, 400 : 400 + black] = 0
    monkeypatch.setitem(globals(), "page_of_lines", lambda: grey)
    intended = followed(node, slowness, True, 7)
    question = asked(intended, READER, [intended["rows"][-1][0] / 5000])
    question["read"]["arm"] = ARM
    (found,) = node([question])
    rows = np.array(found["led"]["rows"])
    times, speeds = rows[:, 0] / 5000, rows[:, 1] / 1e6
    assert np.diff(rows[:, 0]).max() <= 2
    table = "".join(f'{k} = "{v} {u}"\n' for (k, v), u in zip(ARM.items(), UNITS, strict=True))
    reading = load_reading(saved(intended, f"{READER}\n[hand]\n{table}", tmp_path / "a.json"))
    hand = pd.scan(reading.device, reading.page, reading.hand).hand
    assert hand is not None
    exact, meant = (np.asarray(path.velocity(times)[0]) for path in (hand.path, hand.intended))
    lost = np.abs(meant - exact).max()
    assert lost > (0.4 if black else 0.1) * meant.max()
    assert np.abs(speeds - exact).max() < 2e-3 * lost
    place, expected = doubles(found["place"])[0], float(hand.path.position(times[-1])[0])
    assert abs(place - expected) < 2e-3 * hand.error


def random_hand(node: Ask, seed: int) -> dict[str, Any]:
    """A hand that wanders over the page, at any slowness, freely or along a ruler."""
    random = np.random.default_rng([46, seed])
    slowness = int(random.choice([40, 10, 1]))
    count = {40: 700, 10: 260, 1: 40}[slowness]
    x = 0.006 + np.cumsum(random.uniform(0.2, 1.8, count) * 0.03 / count)
    y = 0.00625 + np.cumsum(random.normal(0.0, 1e-4, count)) * random.uniform(0.0, 0.5)
    x += random.normal(0.0, 3e-5, count)
    aims = [{"x": a, "y": b} for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    straight = bool(random.random() < 0.3)
    (hand,) = node([{"follow": {"slowness": slowness, "straight": straight, "aims": aims}}])
    return dict(hand)


@pytest.mark.explore
@pytest.mark.parametrize("begin", range(0, cases(500), 25))
def test_random_hands_move_the_pins_as_in_python(node: Ask, tmp_path: Path, begin: int) -> None:
    """No rate of pictures changes a bit; lines have the bits of Python, positions its digits."""
    few = READER.replace("columns = 4", "columns = 2").replace("rows = 4", "rows = 1")
    rigid = few.replace('stiffness = "300 N/m"\n', "").replace('damping = "0.3 N*s/m"\n', "")
    devices = (few, rigid)
    compared = lines = 0
    for seed in range(begin, begin + 25):
        random = np.random.default_rng([47, seed])
        axis = f'spot_scale = 0.5\naxis = "{random.uniform(-30.0, 30.0):.3f} deg"\n'
        device = devices[seed % 2].replace("spot_scale = 0.5\n", axis)
        hand = random_hand(node, seed)
        end = hand["rows"][-1][0] / 5000
        rates = random.uniform(15, 300, 2).tolist()
        found, other = node([asked(hand, device, pictures(end, rate, seed)) for rate in rates])
        assert (found["end"], found["lines"]) == (other["end"], other["lines"]), f"hand {seed}"
        reading = load_reading(saved(hand, device, tmp_path / "reading.json"))
        done = pd.scan(reading.device, reading.page, reading.hand)
        sampled = np.reshape(doubles(found["sampled"]), (-1, 1 + len(done.pins)))
        for number, pin in enumerate(done.pins):
            expected = pin.motion.position(sampled[:, 0])
            # A series is summed in another order where a scan pauses than where it is read later.
            assert_allclose(sampled[:, 1 + number], expected, 1e-13, 1e-17, err_msg=f"hand {seed}")
            compared += len(expected)
        for line, judged in zip(found["lines"], done.evaluate().lines, strict=True):
            lag = None if np.isnan(judged.begin.lag) else judged.begin.lag
            assert (line["pin"], line["outcome"], line["lag"]) == (judged.pin, judged.fate, lag)
            lines += 1
    assert compared > 5000
    assert lines > 25


def pin_luminance(done: pd.Scan, pin: int, t: float) -> float:
    return float(done.scene.at(*done.spot(pin, [t]).T)[0])


def test_a_hand_follows_its_pointer_without_a_swing(node: Ask) -> None:
    for slowness in (40, 10, 1):
        aims = [{"x": 0.004, "y": 0.006}] + [{"x": 0.014, "y": 0.006}] * 120
        (hand,) = node([{"follow": {"slowness": slowness, "straight": False, "aims": aims}}])
        times, vx, vy = np.array([[0, 0, 0], *hand["rows"]]).T
        places = np.cumsum(0.5 * (vx[1:] + vx[:-1]) * np.diff(times)) / 5000 / PLACES
        assert (vx >= 0).all() and not vy.any()
        assert places[-1] == pytest.approx(0.010, abs=5e-6)
        assert places.max() < 0.010 + 5e-6


def test_bad_readings_are_refused(tmp_path: Path) -> None:
    hand = {"start": [4000, 6000], "rows": [[40, 1000, 0], [80, 2000, 0]]}
    good = json.loads(saved(hand, READER, tmp_path / "good.json").read_text("utf-8"))
    for change, message in (
        ({"format": "pindrive reading 9"}, "format must be 'pindrive reading 1', got"),
        ({"device": "mass = "}, "is no whole reading"),
        ({"hand": {"start": [0, 0]}}, "'rows' is missing"),
        ({"hand": {"start": [0, 0], "rows": [[40, 1, 0], [40, 1, 0]]}}, "must be greater than"),
        ({"page": good["page"] | {"rows": 3}}, "is no whole reading"),
        ({"page": good["page"] | {"luminance": "AAAA"}}, "is no whole reading"),
    ):
        path = tmp_path / "bad.json"
        path.write_text(json.dumps(good | change), "utf-8")
        with pytest.raises(ValueError, match=r"bad\.json") as refused:
            load_reading(path)
        assert message in str(refused.value), str(refused.value)
    (tmp_path / "text.json").write_text("no", "utf-8")
    with pytest.raises(ValueError, match="is no reading, which is JSON"):
        load_reading(tmp_path / "text.json")
    with pytest.raises(ValueError, match="cannot be read"):
        load_reading(tmp_path / "none.json")
    with pytest.raises(ValueError, match="holds no reading"):
        load_reading("https://example.org/studio.html#read=AAAA")


def test_the_command_scans_a_saved_reading(tmp_path: Path) -> None:
    rows = [[40 * k, 60_000 if 0 < k < 60 else 0, 0] for k in range(1, 62)]
    path = saved({"start": [4000, 6000], "rows": rows}, READER, tmp_path / "reading.json")
    target = tmp_path / "lines.csv"
    done = CliRunner().invoke(app, ["scan", str(path), "--lines", str(target)])
    assert done.exit_code == 0, done.output
    reading = load_reading(path)
    shown = pd.scan(reading.device, reading.page, reading.hand).evaluate()
    assert len(target.read_text("utf-8").splitlines()) == 1 + len(shown.lines) > 10
    refused = CliRunner().invoke(app, ["scan", str(path), "--text", "a"])
    assert refused.exit_code == 2
    assert "a saved reading has its device, page and hand" in refused.output
