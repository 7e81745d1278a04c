"""The evaluation that each method of a result makes."""

from typing import Final

VIEWS: Final = {
    "Scan.evaluate": "perception:evaluate",
}
"""Module and function of each method."""
