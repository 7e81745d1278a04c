"""The table of quantities, fourth part: what a scan is judged by, and what is found."""

from __future__ import annotations

from typing import Final

from pindrive.quantities.quantity import Quantity, between

GLEESON: Final = "Gleeson, Horschel & Provancher: direction of tangential motion of skin"
HANDS: Final = "hand speed in finger studies, 20-100 mm/s (arXiv 2505.11162)"
FELT: Final = between(1e-9, 1.0)

CRITERIA: Final[tuple[Quantity, ...]] = (
    Quantity(
        "felt",
        "d_1",
        "m",
        "motion that is felt as a pulse",
        FELT,
        45e-6,
        "9-45 µm at 20-150 Hz on glabrous skin, the upper end "
        "(Hämäläinen & Järvilehto 1981, Brain Res. 219:1)",
        "judge",
        absent=45e-6,
    ),
    Quantity(
        "direction",
        "d_2",
        "m",
        "motion of skin whose direction is perceived",
        FELT,
        5e-5,
        f"{GLEESON}, from 0.05 mm",
        "judge",
        absent=5e-5,
    ),
    Quantity(
        "direction_sure",
        "d_3",
        "m",
        "motion of skin whose direction is told right in more than 95 % of cases",
        FELT,
        2e-4,
        f"{GLEESON}, 0.2 mm",
        "judge",
        absent=2e-4,
    ),
    Quantity(
        "direction_speed",
        "v_3",
        "m/s",
        "speed at which it must be gone for that",
        between(1e-9, 1e3),
        2e-3,
        f"{GLEESON}, 2 mm/s",
        "judge",
        absent=2e-3,
    ),
    Quantity(
        "echo",
        "h_e",
        "1",
        "a swing this part as high as the line before it is a line that is not there",
        between(1e-6, 1.0),
        0.5,
        "assumed",
        "judge",
        absent=0.5,
    ),
)
"""The limits that a scan is judged by: a table of a device file."""

_FOUND: Final = (
    ("latency_on", "t_l,on", "s", "from a line's first edge until the pin goes along"),
    ("latency_off", "t_l,off", "s", "from its last edge until the pin comes back"),
    ("lag_on", "l_on", "m", "what the hand goes until the pin goes along"),
    ("lag_off", "l_off", "m", "what the hand goes until the pin comes back"),
    ("stroke", "h", "m", "how far the line moves the pin"),
    ("skin_on", "d_on", "m", "how far the skin moves as a line begins"),
    ("skin_off", "d_off", "m", "how far the skin moves as it ends"),
    ("smear_time", "t_s", "s", "from the pin's release until it has settled"),
    ("smear", "l_s", "m", "what the hand goes until then: the smear"),
    ("overshoot", "o", "1", "swing beyond the place of rest, a part of the way"),
    ("contrast", "C", "1", "crest against trough, (P - T) / (|P| + |T|)"),
)

LINE: Final[tuple[Quantity, ...]] = tuple(
    Quantity(f"line.{name}", symbol, unit, meaning) for name, symbol, unit, meaning in _FOUND
)
"""What is found of each line under each pin."""

JUDGED: Final[tuple[Quantity, ...]] = tuple(
    Quantity(f"judged.{name}", symbol, "", meaning)
    for name, symbol, meaning in (
        ("lines", "n", "printed lines that passed whole under a pin, counted under each pin"),
        ("shown", "n_1", "shown: the pin went along, and the skin moved enough to be felt"),
        ("unseen", "n_2", "missed: the control block did not see them"),
        ("merged", "n_3", "missed: the magnet or the pin was not yet back from the line before"),
        ("faint", "n_4", "missed: the pin did not go along, or the skin did not move enough"),
        ("echoes", "n_5", "false: swings forward that no magnet made, felt like a line"),
        ("unsettled", "n_6", "shown, yet not settled before the next line or the hand's stop"),
        ("direction", "n_7", "shown, and the skin moved enough to tell its direction"),
        ("sure", "n_8", "shown, and it moved enough to tell it right in 95 % of cases"),
    )
)
"""What is found of a scan."""

SPEED: Final[tuple[Quantity, ...]] = (
    Quantity("speed.pitch", "p", "m", "distance between two lines", between(1e-6, 10.0)),
    Quantity("speed.width", "w", "m", "width of the lines", between(1e-7, 10.0)),
    Quantity(
        "speed.part",
        "r",
        "1",
        "part of its way that the pin must be back between",
        between(1e-6, 1.0),
        source="assumed",
        absent=0.5,
    ),
    Quantity(
        "speed.slowest",
        "v_min",
        "m/s",
        "slowest hand tried",
        between(1e-4, 100.0),
        source=f"a fourth of the slowest of {HANDS}",
        absent=0.005,
    ),
    Quantity(
        "speed.fastest",
        "v_max",
        "m/s",
        "fastest hand tried",
        between(1e-4, 100.0),
        source=f"ten times the fastest of {HANDS}",
        absent=1.0,
    ),
)
"""What the largest hand speed is found for."""

JUDGE: Final = LINE + JUDGED + SPEED
"""What is found of scans and speeds."""
