"""The figures, one file for each, and their common style."""

from pindrive.lazy import require

require("matplotlib")
