"""A scan as a moving picture: its frames are the scan's, its files whole or not there."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from pindrive import Contact, Drive
from pindrive.cli.app import app
from pindrive.device import Device, PinArray, Scene, lines, scan
from pindrive.evaluation import Evaluation, evaluate
from pindrive.plot import animation as film
from pindrive.plot.animation import FRAMES, SIZE, animate, animation_format, frame_times

MINIMAL = Path(__file__).parents[1] / "minimal.toml"
DRIVE = Drive(
    mass=0.010,
    stiffness=100.0,
    damping=0.32,
    plate=Contact(0.022, 0.0265),
    finger=Contact(0.005, 0.0075),
)


@pytest.fixture(scope="module")
def evaluated() -> Evaluation:
    scene = Scene.from_grating([0.006], count=2, margin=0.006, height=0.006)
    path = lines([scene.lines[0]], 0.002, 0.019, speed=0.1, return_speed=0.15)
    return evaluate(scan(Device(drive=DRIVE, array=PinArray([(0.0, 0.0)])), scene, path))


def test_frames_are_even_in_time_and_end_with_the_scan(evaluated: Evaluation) -> None:
    path = evaluated.scan.path
    times = frame_times(path, 3.0)
    assert times[0] == path.begin and times[-1] == path.end
    assert np.diff(times)[:-1] == pytest.approx(1.0 / (3.0 * FRAMES))
    for bad in (0.0, -1.0, float("nan"), 1e6):
        with pytest.raises(ValueError, match=r"`slow` must be (greater than 0|at most \d)"):
            frame_times(path, bad)


def test_a_gif_shows_each_frame(evaluated: Evaluation, tmp_path: Path) -> None:
    target, reported = tmp_path / "film.gif", list[tuple[int, int]]()
    animate(
        evaluated, target, "gif", slow=2.0, progress=lambda done, of: reported.append((done, of))
    )
    times = frame_times(evaluated.scan.path, 2.0)
    assert reported == [(i + 1, len(times)) for i in range(len(times))]
    with Image.open(target) as image:
        assert image.size == SIZE
        count = getattr(image, "n_frames", 1)
        lasts, reddest = 0.0, []
        for i in range(count):
            image.seek(i)
            lasts += image.info["duration"]
            pixels = np.asarray(image.convert("RGB"), int)
            reddest.append((pixels @ [2, -1, -1] > 200)[: SIZE[1] // 2].sum())
    assert lasts == pytest.approx(1000.0 / FRAMES * len(times))
    (pin,) = evaluated.scan.pins
    some_on = pin.commands.on(times)
    assert some_on.any() and not some_on.all()
    assert count == len(times), "no two frames are alike"
    lit = np.array(reddest)  # the pin, red while its magnet is on, beside the red way
    assert lit[some_on].mean() > lit[~some_on].mean() + 20


def test_moving_pins_keep_their_places(evaluated: Evaluation) -> None:
    times = frame_times(evaluated.scan.path, 4.0)
    stage = film._Stage.of(evaluated, times, 4.0)
    (mouse, _, spots), (pins, arrows) = (
        [artist for axes, artist in stage.moving if axes is stage.moving[k][0]] for k in (0, 3)
    )
    (pin,) = evaluated.scan.pins
    for i in (0, len(times) // 2, len(times) - 1):
        stage.frame(i)
        x, y = evaluated.scan.path.position(times[i])
        middle = np.array([mouse.get_x() + 0.5 * mouse.get_width(), mouse.get_y()])  # type: ignore[attr-defined]
        assert middle[0] == pytest.approx(1e3 * x)
        assert spots.get_offsets()[0] == pytest.approx([1e3 * x, 1e3 * y])  # type: ignore[attr-defined]
        against = -1e3 * float(pin.position(times[i]))  # the hand goes to the right
        assert pins.get_offsets()[0] == pytest.approx([against, 0.0])  # type: ignore[attr-defined]
        ((begin, end),) = arrows.get_segments()  # type: ignore[attr-defined]
        assert begin == pytest.approx([against, 0.0])
        assert np.sign(end[0] - begin[0]) == -np.sign(float(pin.skin_force(times[i])))


@pytest.mark.skipif(os.name == "nt", reason="the stand-in for ffmpeg is a script")
@pytest.mark.parametrize("fails", [False, True])
def test_mp4_frames_go_to_ffmpeg(
    evaluated: Evaluation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: bool
) -> None:
    stand_in = tmp_path / "ffmpeg"
    end = "print('no such codec', file=sys.stderr); sys.exit(1)" if fails else ""
    stand_in.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{tmp_path}/stand_in.py" "$@"\n')
    (tmp_path / "stand_in.py").write_text(
        "import sys\n"
        "data = sys.stdin.buffer.read()\n"
        "open(sys.argv[-1], 'w').write(f'{len(data)} {sys.argv[1:]}')\n"
        f"{end}\n"
    )
    stand_in.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    target = tmp_path / "film.mp4"
    assert animation_format(target) == "mp4"
    if fails:
        with pytest.raises(ValueError, match="ffmpeg could not write MP4: no such codec"):
            animate(evaluated, target, "mp4", slow=1.0)
        return
    animate(evaluated, target, "mp4", slow=1.0)
    size, _, options = target.read_text().partition(" ")
    assert int(size) == 4 * SIZE[0] * SIZE[1] * len(frame_times(evaluated.scan.path, 1.0))
    assert f"'{SIZE[0]}x{SIZE[1]}'" in options and "'rgba'" in options


def test_ffmpeg_writes_a_real_mp4(evaluated: Evaluation, tmp_path: Path) -> None:
    if film.ffmpeg() is None:
        pytest.skip("no ffmpeg here")
    target = tmp_path / "film.mp4"
    animate(evaluated, target, "mp4", slow=1.0)
    assert target.read_bytes()[4:8] == b"ftyp"


def test_without_ffmpeg_the_remedy_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    target = tmp_path / "film.mp4"
    command = ["scan", str(MINIMAL), "--text", "I", "--animate", str(target)]
    refused = CliRunner().invoke(app, command)
    assert refused.exit_code == 2
    assert "MP4 takes ffmpeg, which is not here" in refused.output
    assert "or write a .gif" in refused.output
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_a_gif_or_nothing(tmp_path: Path) -> None:
    command = ["scan", str(MINIMAL), "--text", "I", "--slow", "1"]
    target = tmp_path / "film.gif"
    done = CliRunner().invoke(app, [*command, "--animate", str(target)])
    assert done.exit_code == 0, done.output
    assert f"Wrote {target}" in done.output
    assert target.read_bytes()[:6] == b"GIF89a"
    target.unlink()
    for bad, words in (
        (["--animate", str(target), "--slow", "0"], "--slow must be greater than 0, got 0.0"),
        (["--animate", str(tmp_path / "film.avi")], "must end in .gif or .mp4"),
        (["--lines", "a.csv", "--output", "./a.csv"], "is named twice"),
    ):
        refused = CliRunner().invoke(app, [*command, *bad])
        assert refused.exit_code == 2
        assert words in refused.output
    assert list(tmp_path.iterdir()) == []
