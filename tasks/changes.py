"""Files that changed of late, for the steps of the gate that check changes alone."""

from __future__ import annotations

import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DAY = 86400
"""Seconds before the last commit in which a change counts."""


def git(*arguments: str) -> str:
    """Return the output of git; empty if it fails."""
    done = subprocess.run(
        ["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return done.stdout if done.returncode == 0 else ""


def changed_files() -> set[str] | None:
    """Return the files that differ from the state a day before the last commit.

    Paths are relative to the root. None if that state is not known: everything may have changed.
    """
    last = git("log", "-1", "--format=%ct").strip()
    before = last and git("rev-list", "-1", f"--before={int(last) - DAY}", "HEAD").strip()
    if not before:
        return None
    new = git("ls-files", "--others", "--exclude-standard")
    return {*git("diff", "--name-only", before).splitlines(), *new.splitlines()}
