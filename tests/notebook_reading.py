"""Output of results in a notebook, read back; and properties of every result."""

from __future__ import annotations

from base64 import b64decode
from html.parser import HTMLParser
from io import BytesIO
from typing import Any

import numpy as np
from PIL import Image

import pindrive as pd


class Parts(HTMLParser):
    """The rows of the tables, the picture, and what is not closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.pictures: list[dict[str, Any]] = []
        self.open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.pictures.append(dict(attrs))
            return
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


def check_faces(result: Any) -> int:
    """Hold a line, a status, a dataset, and for a notebook tables with units and one picture.

    Returns:
        How many rows stand in tables of labels, before that of numbers.
    """
    line = repr(result)
    assert line.startswith("<") and line.endswith(">") and "\n" not in line and len(line) < 200
    assert isinstance(result.status, pd.Status)
    data = result.to_dataset()
    assert data.data_vars
    text = result._repr_html_()
    parts = Parts(text)
    assert parts.open == []
    heads = ["number", "value", "unit", "meaning"]
    labelled = parts.rows.index(heads) if heads in parts.rows else len(parts.rows)
    rows = parts.rows[labelled:]
    assert len(parts.rows) > 1 and all(len(row) == 4 for row in rows)
    assert not any(row[1] in ("nan", "-", "") for row in rows)
    (picture,) = parts.pictures
    kind, _, encoded = picture["src"].partition(",")
    assert kind == "data:image/png;base64"
    with Image.open(BytesIO(b64decode(encoded))) as image:
        assert abs(image.width - int(picture["width"])) <= 1
        assert np.ptp(np.asarray(image.convert("L"))) > 200
    for word in ("http", "<script", 'src="/'):
        assert word not in text
    assert "<b>&" not in text
    return labelled
