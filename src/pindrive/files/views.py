"""The file that each method of a result writes."""

from typing import Final

VIEWS: Final = {
    "Motion.to_csv": "export:to_csv",
    "Scan.to_csv": "export:scan_to_csv",
    "SystemMotion.to_csv": "system_export:to_csv",
}
"""Module and function of each method."""
