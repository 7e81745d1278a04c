"""Text of any script: in the order and the shapes in which it is read, or refused with its name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import features

from command import run
from pindrive.device.page import draw
from pindrive.files.keys import template
from pindrive.quantities import budgets

shaping = pytest.mark.skipif(
    not (features.check("raqm") and features.check("fribidi")), reason="no FriBiDi here"
)
HEIGHT = 60.0


def ink(text: str) -> NDArray[np.bool_]:
    """Return the black pixels of a line, cut to its width; rows as on the page."""
    values, _ = draw(text, HEIGHT, 2.0 * HEIGHT, HEIGHT)
    black = values < 0.5
    columns = np.flatnonzero(black.any(axis=0))
    return np.asarray(black[:, columns[0] : columns[-1] + 1])


def alike(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> bool:
    """Return True if two pieces show one letter, within a pixel."""
    rows, columns = (min(one.shape[i], other.shape[i]) for i in (0, 1))
    apart = one[:rows, :columns] != other[:rows, :columns]
    return bool(apart.mean() < 0.12 and abs(one.shape[1] - other.shape[1]) <= 3)


def pieces(text: str) -> list[NDArray[np.bool_]]:
    """The parts of a line that no white column divides, from left to right."""
    black = ink(text)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], black.any(axis=0), [0]]).astype(int)))
    return [black[:, a:b] for a, b in zip(edges[::2], edges[1::2], strict=True)]


def test_latin_runs_from_left_to_right() -> None:
    left, right = pieces("HA")
    assert alike(left, ink("H")) and alike(right, ink("A"))
    assert not alike(left, ink("A"))


@shaping
def test_hebrew_runs_from_right_to_left() -> None:
    alef, bet = "\u05d0", "\u05d1"
    left, right = pieces(alef + bet)
    assert alike(left, ink(bet)) and alike(right, ink(alef))
    assert not alike(left, ink(alef))


@shaping
def test_numbers_within_hebrew_run_from_left_to_right() -> None:
    one, two, alef = pieces("\u05d0 17")
    assert alike(one, ink("1")) and alike(two, ink("7")) and alike(alef, ink("\u05d0"))


@shaping
def test_arabic_letters_join() -> None:
    seen = "\u0633"
    joined, alone = ink(seen + seen), ink(seen)
    assert len(pieces(seen + seen)) == 1 == len(pieces(seen))
    assert joined.shape[1] < 1.9 * alone.shape[1]  # the first has lost its tail
    apart = pieces(seen + "\u200c" + seen)  # told not to join
    assert len(apart) == 2
    assert alike(apart[0], alone) and alike(apart[1], alone)


@shaping
def test_marks_stand_above_their_letter() -> None:
    assert ink("q\u0301").shape[1] <= ink("q").shape[1] + 8
    assert ink("q\u0301").sum() > ink("q").sum()


def test_marks_that_make_one_character_take_no_shaping(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(features, "check", lambda _: False)
    assert np.array_equal(ink("e\u0301"), ink("\u00e9"))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("\u05e9\u05dc\u05d5\u05dd", '"\u05e9" (U+05E9 HEBREW LETTER SHIN)'),
        ("a \u0633", '"\u0633" (U+0633 ARABIC LETTER SEEN)'),
        ("q\u0301", '"\u0301" (U+0301 COMBINING ACUTE ACCENT)'),
        ("\u0915", '"\u0915" (U+0915 DEVANAGARI LETTER KA)'),
    ],
)
def test_without_shaping_a_script_is_refused(
    text: str, named: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(features, "check", lambda _: False)
    with pytest.raises(ValueError) as refused:
        draw(text, HEIGHT, HEIGHT, HEIGHT)
    assert str(refused.value) == (
        f"text: {named} is of a script that must be shaped, for which the library FriBiDi is not "
        "installed; install it (libfribidi0, fribidi), or give a picture with `image`"
    )


@pytest.mark.parametrize(
    "plain",
    ["Stra\u00dfe 10 %", "\u03b1\u03b2\u03b3", "\u0416\u0443\u043a", "\u2126 \u2192 \u00b5"],
)
def test_plain_scripts_are_alike_on_every_machine(
    plain: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with_raqm = draw(plain, HEIGHT, HEIGHT, HEIGHT)[0]
    monkeypatch.setattr(features, "check", lambda _: False)
    assert np.array_equal(draw(plain, HEIGHT, HEIGHT, HEIGHT)[0], with_raqm)


@shaping
def test_missing_characters_of_the_font_are_named() -> None:
    with pytest.raises(
        ValueError, match=r"lacks .* \(U\+0915 DEVANAGARI LETTER KA\); give another"
    ):
        draw("\u0915", HEIGHT, HEIGHT, HEIGHT)


def test_letters_and_texts_have_a_size(tmp_path: Any) -> None:
    with pytest.raises(ValueError, match=r"height of the text must be at least 1 pixel.* got 0.5"):
        draw("A", 0.5, 1.0, 1.0)
    with pytest.raises(ValueError, match="the characters of the text must be at most 100000, got"):
        draw("i" * (budgets.CHARACTERS.most + 1), HEIGHT, HEIGHT, HEIGHT)
    file = tmp_path / "device.toml"
    file.write_text(template(whole=True), encoding="utf-8")
    said = run("scan", file, "--text", "A", "--set", "text_height=0.01 mm")
    assert said.exit_code == 2
    assert said.stderr.startswith("the height of the text must be at least 1 pixel")
