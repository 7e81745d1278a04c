"""Scenes: every kind of image, text, lines; sampled between pixels; and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from pindrive.device import Scene

GREY = np.array([[0, 51, 102], [153, 204, 255]], np.uint8)


def read(tmp_path: Path, image: Image.Image, name: str = "page.png", **how: Any) -> Scene:
    image.save(tmp_path / name, **how)
    return Scene.from_image(tmp_path / name, 1e-3)


def test_grey_and_its_frame(tmp_path: Path) -> None:
    scene = read(tmp_path, Image.fromarray(GREY))
    assert_allclose(scene.luminance, GREY / 255.0)
    assert scene.extent == pytest.approx((0.0, 0.003, 0.0, 0.002))


def test_colour_palette_and_bilevel(tmp_path: Path) -> None:
    rgb = Image.merge("RGB", [Image.fromarray(GREY)] * 3)
    assert_allclose(read(tmp_path, rgb).luminance, GREY / 255.0, atol=1e-12)
    assert_allclose(read(tmp_path, rgb.convert("P")).luminance, GREY / 255.0, atol=0.02)
    assert_allclose(
        read(tmp_path, rgb.convert("1", dither=Image.Dither.NONE)).luminance, 1.0 * (GREY > 127)
    )
    red = Image.new("RGB", (2, 2), (255, 0, 0))
    assert_allclose(read(tmp_path, red).luminance, 0.299)
    assert_allclose(read(tmp_path, red.convert("CMYK"), "page.tif").luminance, 0.299, atol=0.02)


def test_transparent_is_white(tmp_path: Path) -> None:
    alpha = Image.fromarray(np.full((2, 3), 0, np.uint8))
    black = Image.merge("LA", [Image.new("L", (3, 2), 0), alpha])
    assert_allclose(read(tmp_path, black).luminance, 1.0)
    half = Image.new("RGBA", (2, 2), (0, 0, 0, 128))
    assert_allclose(read(tmp_path, half).luminance, 127 / 255, atol=0.005)
    palette = Image.new("P", (2, 2), 0)
    palette.putpalette([0, 0, 0, 255, 255, 255])
    assert_allclose(read(tmp_path, palette, transparency=0).luminance, 1.0)


def test_sixteen_bits(tmp_path: Path) -> None:
    deep = Image.fromarray(np.array([[0, 1000], [30000, 65535]], np.uint16))
    expected = np.array([[0, 1000], [30000, 65535]]) / 65535
    assert_allclose(read(tmp_path, deep).luminance, expected)
    assert_allclose(read(tmp_path, deep, "page.tif").luminance, expected)


def test_exif_orientation(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6  # the camera was turned: the first row is at the right
    turned = read(tmp_path, Image.fromarray(GREY), exif=exif)
    assert_allclose(turned.luminance, np.rot90(GREY, -1) / 255.0)


def test_resolution_from_the_file(tmp_path: Path) -> None:
    Image.fromarray(GREY).save(tmp_path / "page.png", dpi=(254, 254))
    assert Scene.from_image(tmp_path / "page.png").pixel == pytest.approx(1e-4, rel=1e-4)
    Image.fromarray(GREY).save(tmp_path / "bare.png")
    with pytest.raises(ValueError, match=r"bare.png: does not state its resolution; give scan."):
        Scene.from_image(tmp_path / "bare.png")
    Image.fromarray(GREY).save(tmp_path / "fax.png", dpi=(204, 98))
    with pytest.raises(ValueError, match=r"must be the same across and down, got 203.98"):
        Scene.from_image(tmp_path / "fax.png")


def test_unreadable_images(tmp_path: Path) -> None:
    (tmp_path / "text.png").write_text("no image", encoding="utf-8")
    (tmp_path / "empty.png").write_bytes(b"")
    Image.fromarray(np.zeros((200, 200), np.uint8)).save(tmp_path / "whole.png")
    whole = (tmp_path / "whole.png").read_bytes()
    (tmp_path / "half.png").write_bytes(whole[: len(whole) // 2])
    for name in ("text.png", "empty.png", "half.png", "none.png", "."):
        with pytest.raises(ValueError, match="cannot be read: "):
            Scene.from_image(tmp_path / name, 1e-3)


def test_linear_between_the_middles_of_pixels() -> None:
    scene = Scene(np.array([[0.0, 1.0], [0.5, 0.5]]), 1e-3, (0.01, 0.02))
    x, y = 0.0105, 0.0205
    assert scene.at(x, y) == pytest.approx(0.0, abs=1e-12)
    assert scene.at(x + 0.25e-3, y) == pytest.approx(0.25)
    assert scene.at(x + 1e-3, y) == pytest.approx(1.0)
    assert scene.at(x + 0.5e-3, y + 0.5e-3) == pytest.approx(0.5)
    assert scene.at(0.01, 0.02) == 0.0  # the corner's half pixels are its pixel's
    assert scene.at(np.full((2, 3), x), y).shape == (2, 3)
    plane = np.add.outer(np.arange(5) * 0.1, np.arange(7) * 0.05)
    slope = Scene(plane, 1e-3)
    rng = np.random.default_rng(5)
    px, py = rng.uniform(0.5e-3, 6.5e-3, 100), rng.uniform(0.5e-3, 4.5e-3, 100)
    plain = (py / 1e-3 - 0.5) * 0.1 + (px / 1e-3 - 0.5) * 0.05
    assert_allclose(slope.at(px, py), plain, atol=1e-12)


def test_paper_beyond_the_page_is_blank() -> None:
    scene = Scene(np.full((2, 3), 0.25), 1e-3)
    x = [-1.0, -1e-6, 0.0, 0.0015, 0.003, 0.0030001, 7.0]
    assert_allclose(scene.at(x, 0.001), [1.0, 1.0, 0.25, 0.25, 0.25, 1.0, 1.0])
    assert_allclose(scene.at(0.001, [-1e-6, 0.001, 0.0021]), [1.0, 0.25, 1.0])


@pytest.mark.parametrize("shape", [(0, 3), (3, 0), (3,), (2, 2, 3)])
def test_empty_scenes_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="luminance must be rows and columns of pixels"):
        Scene(np.ones(shape), 1e-3)


def test_luminance_out_of_range_is_refused() -> None:
    with pytest.raises(ValueError, match=r"luminance must be .* at most 1, got 1.5"):
        Scene(np.array([[0.0, 1.5]]), 1e-3)
    with pytest.raises(ValueError, match="got nan"):
        Scene(np.array([[0.0, np.nan]]), 1e-3)


def test_text_has_its_height_and_place() -> None:
    scene = Scene.from_text("H\nH", height=0.01, pixel=5e-5, margin=0.005, line_pitch=0.03)
    rows = np.flatnonzero(scene.dark().any(axis=1)) * scene.pixel
    parts = np.split(rows, np.flatnonzero(np.diff(rows) > 0.001) + 1)
    assert len(parts) == len(scene.lines) == 2
    for part, middle in zip(parts, scene.lines, strict=True):
        assert np.ptp(part) == pytest.approx(0.01, abs=2e-4)
        assert part.mean() == pytest.approx(middle, abs=2e-4)
    assert scene.lines[1] - scene.lines[0] == pytest.approx(0.03)
    columns = np.flatnonzero(scene.dark().any(axis=0)) * scene.pixel
    left, right, _, _ = scene.extent
    assert columns[0] - left == pytest.approx(0.005, abs=2e-4)
    assert right - columns[-1] == pytest.approx(0.005, abs=2e-4)


def test_text_that_cannot_be_shown() -> None:
    with pytest.raises(ValueError, match="text must be at least one character that is drawn"):
        Scene.from_text(" \n ")
    with pytest.raises(
        ValueError, match=r'the font DejaVuSans.ttf lacks "漢" \(U\+6F22 CJK UN.*\); give another'
    ):
        Scene.from_text("a漢")
    with pytest.raises(ValueError, match=r"none.ttf: is not a font that can be read"):
        Scene.from_text("a", font="none.ttf")
    with pytest.raises(
        ValueError,
        match=r"the pixels of the page must be at most 40000000, got \d+ \(\d+ by \d+; take larger",
    ):
        Scene.from_text("Hello", pixel=1e-7)


def test_grating_is_exact_between_pixels() -> None:
    """Lines of a pitch that is no whole number of pixels keep their width on the average."""
    scene = Scene.from_grating([0.00333, 0.001], count=5, pixel=1e-4, margin=0.002)
    row = scene.luminance[scene.luminance.shape[0] // 2]
    assert (1.0 - row).sum() * scene.pixel == pytest.approx(5 * (0.00333 + 0.001) / 2, rel=1e-9)
    assert scene.at(0.002 + 0.00333 * 2.25, scene.lines[0]) == pytest.approx(0.0)
    assert scene.at(0.002 + 0.00333 * 2.75, scene.lines[0]) == pytest.approx(1.0)
