"""The table of quantities, second part: the whole device and how a hand moves it over a page.

Bounds are far outside of what any such device has, and such that nothing computed from values
within them overflows or vanishes. How much work they ask for together is another matter: budgets.
"""

from __future__ import annotations

from math import radians
from typing import Final

from pindrive.quantities_judge import CRITERIA
from pindrive.quantities_magnet import COIL, FINE, MAGNET, SHARE
from pindrive.quantity import NON_NEGATIVE, Quantity, between

LUMINANCE: Final = between(0.0, 1.0)
ACUTE: Final = between(0.0, radians(90.0))
SPEED: Final = between(1e-4, 100.0)
"""Of a hand."""
PLACE: Final = between(-1e3, 1e3)
"""On the page."""
TURN: Final = radians(720.0)

CONTROL: Final[tuple[Quantity, ...]] = (
    Quantity(
        "sample_rate",
        "f_s",
        "Hz",
        "how often the control block looks at the scene",
        between(0.1, 1e6),
        1000.0,
        "mice report 125 to 1000 times a second (USB HID)",
        "control",
        optional=True,
        remark="1000 Hz unless given",
    ),
    Quantity(
        "latency",
        "t_l",
        "s",
        "from looking to switching the coil",
        between(0.0, 100.0),
        0.005,
        "assumed: a few reports of a mouse",
        "control",
        optional=True,
        remark="5 ms unless given",
    ),
    Quantity(
        "threshold",
        "L_0",
        "1",
        "luminance below which there is information; 0 is black, 1 is white",
        LUMINANCE,
        0.5,
        "assumed: the middle",
        "control",
        optional=True,
        remark="0.5 unless given",
    ),
    Quantity(
        "hysteresis",
        "ΔL",
        "1",
        "switches on this half below the threshold, off this half above it: the whole width",
        LUMINANCE,
        0.1,
        "assumed",
        "control",
        optional=True,
        remark="0.1 unless given; the whole band within 0 and 1",
    ),
)

ARRAY: Final[tuple[Quantity, ...]] = (
    Quantity(
        "columns",
        "n_x",
        "1",
        "pins side by side along the drive axis",
        between(1.0, 1000.0),
        4.0,
        "assumed",
        "array",
        optional=True,
        remark="1 unless given",
    ),
    Quantity(
        "rows",
        "n_y",
        "1",
        "rows of them",
        between(1.0, 1000.0),
        4.0,
        "assumed",
        "array",
        optional=True,
        remark="1 unless given",
    ),
    Quantity(
        "pitch",
        "p",
        "m",
        "distance between neighbouring pins",
        between(1e-6, 1.0),
        0.005,
        "assumed: room for electromagnets 3.5 mm wide; twice that of the dots of a Braille cell",
        "array",
        optional=True,
        remark="5 mm unless given",
    ),
    Quantity(
        "pin_diameter",
        "d_p",
        "m",
        "diameter of a pin: two pins meet where their axes come as close as that",
        between(1e-6, 1.0),
        0.0015,
        "as a Braille dot at its base, 1.4-1.6 mm",
        "array",
        optional=True,
        remark="1.5 mm unless given",
    ),
    Quantity(
        "places",
        "(x_i, y_i)",
        "m",
        "places of the pins in the mouse instead: along the drive axis and across it",
        between(-10.0, 10.0),
        source="assumed: three pins in a triangle",
        section="array",
        optional=True,
        remark="in place of columns, rows and pitch",
        rows_of="places",
        rows=((0.0, -0.002), (0.0, 0.002), (0.0035, 0.0)),
    ),
    Quantity(
        "spot_scale",
        "s",
        "1",
        "the pins' spots stand on the scene as the pins do in the mouse, times this",
        between(0.0, 1000.0),
        1.0,
        "assumed: the scene is felt in its own size",
        "array",
        optional=True,
        remark="1 unless given",
    ),
    Quantity(
        "axis",
        "φ",
        "rad",
        "direction of the drive axis on the page, from its x towards its y",
        between(-TURN, TURN),
        0.0,
        "the paper keeps drive and motion parallel, along the lines of the page",
        "array",
        optional=True,
        remark="0 deg unless given",
    ),
)

SCAN: Final[tuple[Quantity, ...]] = (
    Quantity(
        "hand_speed",
        "v_h",
        "m/s",
        "peak speed of the hand while it reads; a minimum-jerk stroke takes 1.875 length / speed",
        SPEED,
        0.060,
        "hand speed 20-100 mm/s in finger studies (arXiv 2505.11162); the middle",
        "scan",
        optional=True,
        remark="60 mm/s unless given",
    ),
    Quantity(
        "return_speed",
        "v_r",
        "m/s",
        "the same on the way back to the next line",
        SPEED,
        0.1,
        "the upper end of hand speed in finger studies (arXiv 2505.11162)",
        "scan",
        optional=True,
        remark="100 mm/s unless given",
    ),
    Quantity(
        "pause",
        "t_p",
        "s",
        "rest of the hand after each stroke",
        between(0.0, 3600.0),
        0.2,
        "assumed",
        "scan",
        optional=True,
        remark="200 ms unless given",
    ),
    Quantity(
        "line_pitch",
        "h_l",
        "m",
        "distance between the lines of text, and between the hand's strokes",
        between(1e-5, 10.0),
        None,
        "assumed: twice the height of the text",
        "scan",
        optional=True,
        example=0.020,
        remark="of text twice its height, over an image one stroke along its middle, unless given",
    ),
    Quantity(
        "text_height",
        "h_t",
        "m",
        "height of capital letters in text",
        between(1e-5, 10.0),
        0.010,
        "assumed: letters that a pin can follow",
        "scan",
        optional=True,
        remark="10 mm unless given",
    ),
    Quantity(
        "pixel",
        "p_s",
        "m",
        "size of a pixel of the scene",
        between(1e-7, 1.0),
        None,
        "assumed: 254 pixels an inch",
        "scan",
        optional=True,
        example=1e-4,
        remark="of an image its own resolution, of text and lines 0.1 mm, unless given",
    ),
    Quantity(
        "max_angle",
        "γ_max",
        "rad",
        "angle between motion and drive axis beyond which a warning is given",
        ACUTE,
        radians(20.0),
        "assumed: 6 % of the speed is lost at 20 deg, of the force as much",
        "scan",
        optional=True,
        remark="20 deg unless given",
    ),
    Quantity(
        "hand_acceleration",
        "a_max",
        "m/s^2",
        "acceleration of the hand beyond which its recorded speed is taken to jump",
        between(1e-3, 1e6),
        30.0,
        "assumed: five times that of a minimum-jerk stroke of 100 mm in 0.3 s",
        "scan",
        optional=True,
        remark="30 m/s^2 unless given",
    ),
    Quantity(
        "path_deviation",
        "ε_v",
        "1",
        "largest deviation of the piecewise-linear speed from minimum jerk, a part of its peak",
        FINE,
        1e-4,
        "its slope, which is the force of inertia, is then within 3 % of its peak",
        "scan",
        optional=True,
        remark="1e-4 unless given",
    ),
)

DEVICE_INPUTS: Final[tuple[Quantity, ...]] = MAGNET + COIL + CONTROL + ARRAY + SCAN + CRITERIA
"""What a device file may give beyond the drive, in its order."""

DEVICE_PARTS: Final[tuple[Quantity, ...]] = (
    Quantity("place.x", "x", "m", "place of a pin along the drive axis", between(-10.0, 10.0)),
    Quantity("place.y", "y", "m", "place of a pin across the drive axis", between(-10.0, 10.0)),
    Quantity("scene.origin", "x_0", "m", "place of the scene's top left corner", PLACE),
    Quantity("scene.luminance", "L", "1", "luminance of a pixel, black 0, white 1", LUMINANCE),
    Quantity("stroke.length", "D", "m", "length of a stroke", between(1e-9, 2e3)),
    Quantity("stroke.duration", "T", "s", "duration of a stroke", between(1e-12, 1e8)),
    Quantity("hand.time", "t", "s", "time in a recorded path", between(-1e6, 1e6)),
    Quantity("hand.place", "x", "m", "place in a recorded path", PLACE),
    Quantity(
        "coil.resistance", "R", "ohm", "resistance of the winding at 20 °C", between(1e-9, 1e15)
    ),
    Quantity(
        "coil.inductance", "L", "H", "inductance of the coil on the plate", between(1e-15, 1e9)
    ),
    Quantity("coil.current", "I", "A", "full current", between(1e-12, 1e12)),
    Quantity(
        "coil.field",
        "B",
        "T",
        "field in the gap at full current, without saturation",
        between(1e-12, 1e12),
    ),
    Quantity("coil.power", "P_el", "W", "power while it is on", between(1e-15, 1e15)),
    Quantity(
        "coil.duty", "D_th", "1", "part of the time it may be on for the warming allowed", SHARE
    ),
    Quantity(
        "rise_constant", "τ_r", "s", "time constant of the rising current", between(1e-9, 1e6)
    ),
    Quantity(
        "fall_constant", "τ_f", "s", "time constant of the falling current", between(1e-9, 1e6)
    ),
    Quantity(
        "friction_coefficient",
        "μ",
        "1",
        "kinetic friction of the plate over what presses",
        NON_NEGATIVE,
    ),
    Quantity(
        "pin_gap",
        "g_p",
        "m",
        "smallest gap between neighbouring pins along the drive axis; negative where they overlap",
    ),
    Quantity("pin_gap.time", "t_g", "s", "when it is so small"),
)
"""What the parts of a device are made of in Python, and what follows from them."""

PIN: Final[tuple[Quantity, ...]] = (
    Quantity("pin.energised", "t_on", "s", "time its magnet was switched on"),
    Quantity("pin.switchings", "n_on", "", "times its magnet was switched on"),
    Quantity("pin.slips", "n_slip", "", "times it broke loose from the plate while switched on"),
    Quantity("pin.captures", "n_stick", "", "times the plate caught it"),
    Quantity("pin.carried", "t_c", "s", "time the plate carried it"),
    Quantity("pin.peak_displacement", "x_max", "m", "largest deflection, either way"),
    Quantity("pin.peak_skin_force", "R_max", "N", "largest force on the skin, either way"),
    Quantity("pin.peak_stretch", "s_max", "m", "largest stretch of a compliant finger's skin"),
)
"""What each pin did in a scan."""
