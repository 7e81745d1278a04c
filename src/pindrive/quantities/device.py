"""The table of quantities, second part: the whole device and how a hand moves it over a page.

Bounds are far outside of what any such device has, and such that nothing computed from values
within them overflows or vanishes. Budgets limit their joint work: budgets.
"""

from __future__ import annotations

from math import radians
from typing import Any, Final

from pindrive.quantities.quantity import NON_NEGATIVE, Quantity, between, inputs

LUMINANCE: Final = between(0.0, 1.0)
SPEED: Final = between(1e-4, 100.0)
"""Speed of a hand."""
PLACE: Final = between(-1e3, 1e3)
"""On the page."""

CONTROL: Final = inputs(
    "control",
    Quantity(
        "sample_rate",
        "f_s",
        "Hz",
        "rate at which the control block samples the scene",
        1000.0,
        "mice report 125 to 1000 times a second (USB HID)",
    ),
    Quantity(
        "latency",
        "t_l",
        "s",
        "delay from sampling to switching the coil",
        0.005,
        "assumed: a few reports of a mouse",
    ),
    Quantity(
        "threshold",
        "L_0",
        "1",
        "luminance below which the page is black for the control block; 0 is black, 1 is white",
        0.5,
        "assumed: the middle",
    ),
    Quantity(
        "hysteresis",
        "ΔL",
        "1",
        "width of the band about the threshold: on below it, off above it",
        0.1,
        "assumed",
        remark="the band lies within 0 and 1",
    ),
)

ARRAY: Final = inputs(
    "array",
    Quantity(
        "columns",
        "n_x",
        "1",
        "number of pins along the drive axis",
        4.0,
        "assumed",
    ),
    Quantity(
        "rows",
        "n_y",
        "1",
        "number of rows of pins",
        4.0,
        "assumed",
    ),
    Quantity(
        "pitch",
        "p",
        "m",
        "distance between neighbouring pins",
        0.005,
        "assumed: room for electromagnets 3.5 mm wide; twice that of the dots of a Braille cell",
    ),
    Quantity(
        "pin_diameter",
        "d_p",
        "m",
        "diameter of a pin, the smallest distance between axes",
        0.0015,
        "as a Braille dot at its base, 1.4-1.6 mm",
    ),
    Quantity(
        "slot_length",
        "l_s",
        "m",
        "length of the slot in which a pin moves, along the drive axis",
        source="the pin's diameter and 1.4 mm either way: a pin goes up to 1.36 mm, and slots are "
        "cut to 0.1 mm (ISO 2768-1, medium, 3-6 mm); 0.7 mm of wall is left at a pitch of 5 mm",
        example=0.0043,
        remark="without it, the ends of the slot are not checked",
    ),
    Quantity(
        "places",
        "(x_i, y_i)",
        "m",
        "positions of the pins in the mouse, along and across the drive axis",
        source="assumed: three pins in a triangle",
        remark="in place of columns, rows and pitch",
        rows_of="places",
        rows=((0.0, -0.002), (0.0, 0.002), (0.0035, 0.0)),
    ),
    Quantity(
        "spot_scale",
        "s",
        "1",
        "factor from the distances of the pins to those of their sensing spots",
        1.0,
        "assumed: the scene is felt in its own size",
    ),
    Quantity(
        "axis",
        "φ",
        "rad",
        "direction of the drive axis on the page, from x towards y",
        0.0,
        "the paper keeps drive and motion parallel, along the lines of the page",
    ),
)

SCAN: Final = inputs(
    "scan",
    Quantity(
        "hand_speed",
        "v_h",
        "m/s",
        "peak speed of a reading stroke; a minimum-jerk stroke takes 1.875 length / speed",
        0.060,
        "hand speed 20-100 mm/s in finger studies (arXiv 2505.11162); the middle",
    ),
    Quantity(
        "return_speed",
        "v_r",
        "m/s",
        "peak speed of the stroke back to the next line",
        0.1,
        "the upper end of hand speed in finger studies (arXiv 2505.11162)",
    ),
    Quantity(
        "pause",
        "t_p",
        "s",
        "rest of the hand after each stroke",
        0.2,
        "assumed",
    ),
    Quantity(
        "touch",
        "N_f(t)",
        "N",
        "touch force of the finger on each pin, over the time of the scan",
        source="assumed: a finger that rests for 0.4 s, lifts within 20 ms, and presses again",
        remark="one value, rows over time, or a CSV of them, for a finger with a coefficient; "
        "finger.touch_force throughout unless given",
        example=0.060,
        rows_of="profile",
        rows=((0.4, 0.060), (0.42, 0.0), (0.8, 0.0), (0.82, 0.060)),
        seen=between(0.0, 100.0),
    ),
    Quantity(
        "line_pitch",
        "h_l",
        "m",
        "distance between the lines of text, and between the hand's strokes",
        source="assumed: twice the height of the text",
        example=0.020,
        remark="twice the height of text, one stroke along the middle of an image, unless given",
    ),
    Quantity(
        "text_height",
        "h_t",
        "m",
        "height of capital letters in text",
        0.010,
        "assumed: letters that a pin can follow",
    ),
    Quantity(
        "pixel",
        "p_s",
        "m",
        "size of a pixel of the scene",
        source="assumed: 254 pixels an inch",
        example=1e-4,
        remark="resolution of the image, 0.1 mm for text and lines, unless given",
    ),
    Quantity(
        "max_angle",
        "γ_max",
        "rad",
        "angle between motion and drive axis above which a warning is given",
        radians(20.0),
        "assumed: 6 % of the speed is lost at 20 deg, of the force as much",
    ),
    Quantity(
        "hand_acceleration",
        "a_max",
        "m/s^2",
        "largest acceleration of the hand in a recording",
        30.0,
        "assumed: five times that of a minimum-jerk stroke of 100 mm in 0.3 s",
    ),
    Quantity(
        "mouse_resolution",
        "n_m",
        "1/m",
        "resolution of the mouse for recordings in counts",
        1e7 / 254.0,
        "assumed: 1000 to the inch, as usual mice have",
    ),
    Quantity(
        "smoothing_cutoff",
        "f_c",
        "Hz",
        "3 dB cut-off of the low-pass that smooths a raw recording of a mouse",
        20.0,
        "assumed: hands move below 10 Hz; it takes 0.13 % off the peak of a stroke of 0.15 s",
    ),
)

_ARM: Final = "van Beek et al. 2015, 10.1038/srep18004: a relaxed arm at the hand"

HAND: Final = inputs(
    "",
    Quantity(
        "hand.mass",
        "m_h",
        "kg",
        "hand, arm and mouse without its pins, as the drive axis feels them",
        example=0.55,
        source=_ARM,
        remark="without it nothing can slow the hand",
        seen=between(1e-3, 1e2),
    ),
    Quantity(
        "hand.stiffness",
        "k_h",
        "N/m",
        "stiffness of the arm about its intended path",
        example=135.0,
        source=_ARM,
        seen=between(1.0, 1e5),
    ),
    Quantity(
        "hand.damping",
        "b_h",
        "N*s/m",
        "damping of the arm about its intended path",
        example=6.5,
        source=_ARM,
        seen=between(1e-2, 1e4),
    ),
    Quantity(
        "hand.kinetic",
        "F_h",
        "N",
        "kinetic friction of the mouse on the page, which the arm overcomes while it slides",
        example=0.3,
        source="0.2 to 0.8 N on pads (Cabeças 2010, 10.2174/1875934301003010001)",
    ),
    Quantity(
        "hand.static",
        "F_hs",
        "N",
        "static friction of the mouse on the page",
        example=0.4,
        source="assumed: a third above kinetic friction",
        remark="kinetic friction unless given",
    ),
)
"""Hand that gives way to its pins."""

DEVICE_PARTS: Final[tuple[Quantity, ...]] = (
    Quantity(
        "place.x", "x", "m", "place of a pin along the drive axis", bounds=between(-10.0, 10.0)
    ),
    Quantity(
        "place.y", "y", "m", "place of a pin across the drive axis", bounds=between(-10.0, 10.0)
    ),
    Quantity("scene.origin", "x_0", "m", "place of the scene's top left corner", bounds=PLACE),
    Quantity(
        "scene.luminance", "L", "1", "luminance of a pixel, black 0, white 1", bounds=LUMINANCE
    ),
    Quantity("stroke.length", "D", "m", "length of a stroke", bounds=between(1e-9, 2e3)),
    Quantity("stroke.duration", "T", "s", "duration of a stroke", bounds=between(1e-12, 1e8)),
    Quantity("hand.time", "t", "s", "time in a recorded path", bounds=between(-1e6, 1e6)),
    Quantity(
        "margin",
        "h_m",
        "m",
        "white around the text or the lines of a page",
        source="assumed: half the height of the text",
        absent=0.005,
        bounds=between(0.0, 10.0),
    ),
    Quantity(
        "text.pixel",
        "p_s",
        "m",
        "size of a pixel of text and lines",
        source="assumed: 254 pixels an inch",
        absent=1e-4,
        bounds=between(1e-7, 1.0),
    ),
    Quantity("hand.place", "x", "m", "place in a recorded path", bounds=PLACE),
    Quantity(
        "friction_coefficient",
        "μ",
        "1",
        "kinetic friction of the plate over the normal force",
        bounds=NON_NEGATIVE,
    ),
    Quantity(
        "pin_gap",
        "g_p",
        "m",
        "smallest gap between neighbouring pins along the drive axis; negative where they overlap",
    ),
    Quantity("pin_gap.time", "t_g", "s", "time of the smallest gap"),
    Quantity(
        "magnet_gap",
        "g_m",
        "m",
        "smallest gap between neighbouring magnets along the drive axis; negative where they "
        "overlap",
    ),
    Quantity("magnet_gap.time", "t_g", "s", "time of the smallest gap"),
    Quantity(
        "slot_room",
        "g_s",
        "m",
        "least room of a pin to the end of its slot; negative where it goes beyond",
    ),
)
"""Attributes of the parts of a device in Python, and quantities derived from them."""

PIN: Final[tuple[Quantity, ...]] = (
    Quantity("pin.energised", "t_on", "s", "total time with the magnet switched on"),
    Quantity("pin.switchings", "n_on", "", "number of times the magnet was switched on"),
    Quantity("pin.slips", "n_slip", "", "number of slips on the plate while switched on"),
    Quantity("pin.captures", "n_stick", "", "number of sticks on the plate"),
    Quantity("pin.carried", "t_c", "s", "total time of stick on the plate"),
    Quantity("pin.peak_displacement", "x_max", "m", "largest deflection, either way"),
    Quantity("pin.peak_skin_force", "R_max", "N", "largest force on the skin, either way"),
    Quantity("pin.peak_stretch", "s_max", "m", "largest stretch of a compliant finger's skin"),
)
"""Results of each pin of a scan."""

# A single pin of a tactile mouse may be heavy. Sixteen pins under a finger have magnets a few
# millimetres wide, and springs so stiff that no pin reaches the next.
READER: Final[dict[str, dict[str, Any]]] = {
    "drive.mass": {
        "default": 0.001,
        "source": "assumed: 0.12 cm3 of iron and copper at 8.4 g/cm3, a cylinder 3.5 mm wide and "
        "12.4 mm high",
    },
    "drive.stiffness": {
        "default": 250.0,
        "source": "assumed: the magnet below carries the pin 1 mm against it, and neighbours 5 mm "
        "apart do not meet; a natural frequency of 80 Hz",
    },
    "drive.damping": {
        "example": 0.5,
        "source": "the damping ratio 0.5 below, with m = 1 g and k = 250 N/m",
    },
    "drive.damping_ratio": {
        "default": 0.5,
        "source": "assumed, an elastic sleeve: half as much again as the largest of 0.04, 0.16, "
        '0.32 in Fig. 4 of "Dynamics of tactile device drive", read as ratios; it settles sooner',
    },
    "drive.travel": {
        "example": 0.0013,
        "source": "assumed: stops just within the 1.35 mm that the slot below leaves either way",
    },
    "plate.kinetic": {
        "default": None,
        "example": 0.0022,
        "source": "steel on steel, friction coefficient 0.15-0.30 (handbook tables), 0.225 (the "
        "middle) of a weight of 9.8 mN",
        "remark": "in place of a coefficient",
    },
    "plate.static": {
        "default": None,
        "example": 0.00265,
        "source": "steel on steel, 0.27 (oxidised, handbook tables) of a weight of 9.8 mN",
    },
    "plate.coefficient": {"default": 0.225},
    "plate.static_coefficient": {"default": 0.27},
    "plate.coefficient_curve": {
        "remark": "for `pindrive simulate` alone: not where a magnet changes the load",
    },
    "plate.curve": {
        "source": "steel on steel, 0.225 falling to 0.15 of a weight of 9.8 mN",
        "remark": "for `pindrive simulate` alone: not where a magnet changes the load",
        "rows": ((0.0, 0.0022), (0.05, 0.0015)),
    },
    "finger.kinetic": {
        "default": None,
        "example": 0.030,
        "remark": "in place of a coefficient and touch_force",
        "source": "skin, friction coefficient 0.5 (Derler & Gerhardt, review), of 60 mN of touch: "
        "1 N of a finger on sixteen pins, assumed",
    },
    "finger.static": {"default": None, "example": 0.045},
    "finger.coefficient": {"default": 0.5},
    "finger.static_coefficient": {"default": 0.75},
    "finger.coefficient_curve": {
        "remark": "speeds from 0 m/s up; coefficient, stiffness and damping are left out then",
    },
    "finger.touch_force": {
        "default": 0.060,
        "source": "assumed: 1 N of a finger on sixteen pins",
    },
    "finger.load_exponent": {"default": 1.0},
    "finger.reference_touch": {"default": 1.0},
    "plate.touch_share": {"default": 1.0},
    "magnet.outer_diameter": {"default": 0.0035},
    "magnet.height": {"default": 0.0124},
    "magnet.spring_height": {"default": 0.004},
    "magnet.pin_height": {"default": 0.0124},
    "array.slot_length": {"default": 0.0043},
    "finger.curve": {
        "remark": "speeds from 0 m/s up; kinetic, stiffness and damping are left out then",
        "rows": ((0.0, 0.030), (0.05, 0.024)),
    },
    "finger.stiffness": {
        "default": 300.0,
        "example": None,
        "source": "1000 N/m of the whole finger pad (ROBOMECH J. 2017, 10.1186/s40648-017-0080-8, "
        "Table 1); a pin touches a part of it, assumed: a third",
    },
    "finger.damping": {
        "default": 0.3,
        "example": None,
        "source": "1 N*s/m of the whole finger pad (ROBOMECH J. 2017, 10.1186/s40648-017-0080-8, "
        "Table 1); a pin touches a part of it, assumed: a third, as of its stiffness",
    },
    "array.spot_scale": {
        "default": 0.5,
        "source": "assumed: sixteen spots on letters 10 mm high; the page is felt twice as large",
    },
    "motion.plate_load": {
        "source": "assumed: a magnet that held the pin with 1 N, 102 times its weight, releases "
        "it in 5 ms",
        "rows": ((0.0, 103.0), (0.005, 1.0)),
    },
    "motion.displacement": {
        "default": 0.0009,
        "source": "assumed: the pin was carried nearly as far as its magnet can hold it",
    },
    "motion.skin_stretch": {
        "example": 7.5e-5,
        "source": "assumed: half of what static friction holds, 45 mN / (300 N/m)",
    },
}
"""Differing fields of `Quantity`, by the keys of a device file."""
