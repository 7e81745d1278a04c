"""A device file written anew: what the old one says with other values, and why, as comments."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from pindrive.files.device import DeviceFile
from pindrive.files.recording import files_named
from pindrive.motion.friction import COEFFICIENTS


def device_text(
    device: DeviceFile,
    values: Mapping[str, Any],
    target: Path,
    head: Iterable[str],
    comments: Mapping[str, Sequence[str]],
) -> str:
    """The text of a device file.

    Args:
        device: Device that the text describes.
        values: Values of keys set otherwise, as TOML has them.
        target: File of the text; paths in the text are relative to its folder.
        head: Lines at its top.
        comments: Lines above keys.
    """
    tables = {name: dict(table) for name, table in device.tables.items() if table}
    for key, path in files_named(device.tables, device.path.parent).items():
        _put(tables, key, Path(os.path.relpath(path, target.parent)).as_posix())
    for name in ("plate", "finger"):
        if f"{name}.kinetic" in values:  # a force in place of a coefficient
            for other in (*COEFFICIENTS.values(), "touch_force", "reference_touch"):
                tables.get(name, {}).pop(other, None)
    for key, value in values.items():
        _put(tables, key, value)
    if "drive.damping" in values:
        tables["drive"].pop("damping_ratio", None)
    lines = [f"# {_plain(line)}" for line in head]
    for name in ("device", *(name for name in tables if name != "device")):
        if not tables.get(name):
            continue
        lines += ["", f"[{name}]"]
        for key, value in tables[name].items():
            lines += [f"# {_plain(text)}" for text in comments.get(f"{name}.{key}", ())]
            lines.append(f"{key} = {_toml(value)}")
    return "\n".join(lines) + "\n"


def _plain(text: str) -> str:
    """Text that stays in its line."""
    return re.sub(r"[\x00-\x1f\x7f]", " ", text)


def _toml(value: Any) -> str:
    """A value as TOML has it in a line."""
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{name} = {_toml(inner)}' for name, inner in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return json.dumps(value, ensure_ascii=False)


def _put(tables: dict[str, dict[str, Any]], key: str, value: Any) -> None:
    table, _, name = key.partition(".")
    tables.setdefault(table, {})[name] = value
