"""Table of quantities, last part: results of motions and scans, and criteria of the evaluation."""

from __future__ import annotations

from typing import Final

from pindrive.quantities.quantity import NON_NEGATIVE, PAPER, Quantity, between, inputs

_USE: Final[tuple[tuple[str, str, str, str], ...]] = (
    ("reversals", "n_{}", "", "zeros of the sliding velocity in the transient, {}"),
    ("time_stuck", "t_{},stuck", "s", "time in stick in the transient, {}"),
    ("distance_slid", "s_{}", "m", "distance slid in the transient, {}"),
    ("dissipated", "W_{}", "J", "energy turned into heat in the transient, {}"),
    ("peak_force", "R_{},max", "N", "largest friction force on the pin, {}"),
)

_AFTERWARDS: Final[tuple[tuple[str, str, str, str], ...]] = (
    ("reversals", "n_{},T", "", "zeros of the sliding velocity in one period, {}"),
    ("time_stuck", "t_{},T", "s", "time in stick in one period, {}"),
    ("distance_slid", "s_{},T", "m", "distance slid in one period, {}"),
    ("dissipated", "W_{},T", "J", "energy turned into heat in one period, {}"),
    ("power", "P_{}", "W", "mean power of friction at rest or in a steady motion, {}"),
)

_NUMBERS: Final[tuple[tuple[str, str, str, str, str], ...]] = (
    (
        "peak_displacement",
        "x_m,a",
        "m",
        "displacement at the first turning point on the way out",
        "(14)",
    ),
    ("peak_time", "t_a", "s", "time of the peak displacement", "(13)"),
    (
        "trough_displacement",
        "x_m,c",
        "m",
        "displacement at the turning point that follows the peak",
        "(16)",
    ),
    ("trough_time", "t_c", "s", "time of the trough", "(15)"),
    ("swing", "x_m,a - x_m,c", "m", "from peak to trough", "(17)"),
    ("return_velocity", "v_m,b", "m/s", "extreme velocity on the way back", "(20)"),
    ("return_velocity_time", "t_b", "s", "time of the extreme return velocity", "(19)"),
    (
        "first_reversal_time",
        "t_1",
        "s",
        "first time the sliding velocity at the plate is zero",
        "(21)",
    ),
    (
        "settling_time",
        "t_s",
        "s",
        "time from which the position stays within the settling band",
        "the time of the transitional period",
    ),
    (
        "rest_time",
        "t_r",
        "s",
        "time from which the pin stays at rest; infinite without rest",
        "",
    ),
    (
        "last_event_time",
        "t_e",
        "s",
        "time of the last event of a contact; 0 without one, infinite in a cycle",
        "",
    ),
    ("peak_stretch", "s_max", "m", "largest stretch of a compliant finger's skin", ""),
    ("peak_stretch_rate", "s'_max", "m/s", "largest stretch rate of a compliant finger's skin", ""),
    (
        "end_time",
        "t*",
        "s",
        "end of the transient: rest, steady motion, last event of a decay or end of the duration",
        "",
    ),
    ("settled", "", "", "true if the motion settles within its duration", ""),
)
"""Name, symbol, unit, meaning, and where the paper has it."""

TRANSIENT: Final[tuple[Quantity, ...]] = (
    *(
        Quantity(
            f"transient.{name}", symbol, unit, meaning, source=f"{PAPER}, {place}" if place else ""
        )
        for name, symbol, unit, meaning, place in _NUMBERS
    ),
    *(
        Quantity(
            f"transient.{contact}.{name}",
            symbol.format(contact[0]),
            unit,
            meaning.format(where),
        )
        for contact, where in (("plate", "at the plate"), ("finger", "at the finger"))
        for name, symbol, unit, meaning in _USE
    ),
)
"""The numbers of a transient."""

ENDING: Final[tuple[Quantity, ...]] = (
    Quantity(
        "ending.position",
        "x_end",
        "m",
        "rest position, centre of the final oscillation, or position of a drift's line at t = 0",
    ),
    Quantity("ending.steady_since", "t_end", "s", "time from which the motion is steady"),
    Quantity("ending.amplitude", "X_end", "m", "half of the range of the final oscillation"),
    Quantity(
        "ending.period",
        "T_end",
        "s",
        "period of the final oscillation; mean revolution if irregular",
    ),
    Quantity(
        "ending.least_amplitude",
        "X_min",
        "m",
        "half of the range of the smallest revolution of the final oscillation",
    ),
    Quantity("ending.peak_velocity", "v_end", "m/s", "largest speed in the final oscillation"),
    Quantity("ending.rounds", "n_end", "", "revolutions about the centre in one period"),
    Quantity("ending.decay_energy", "W_end", "J", "energy that the final decay still dissipates"),
    Quantity("ending.drift_velocity", "v_drift", "m/s", "velocity of the line a drift follows"),
    Quantity("ending.lag", "x_lag", "m", "distance of a drift behind the balance without friction"),
    Quantity(
        "ending.growth",
        "q_T",
        "",
        "factor in a period of a range that grows, or of the distance from a limit",
    ),
    *(
        Quantity(f"ending.{contact}.{name}", symbol.format(contact[0]), unit, meaning.format(where))
        for contact, where in (("plate", "at the plate"), ("finger", "at the finger"))
        for name, symbol, unit, meaning in _AFTERWARDS
    ),
)
"""Numbers of the ending of a motion."""

FINAL: Final[tuple[Quantity, ...]] = (
    Quantity("final.position", "x_T", "m", "position at the end of the duration, or at rest"),
    Quantity("final.velocity", "v_T", "m/s", "velocity at the end of the duration, or at rest"),
)
"""The state at the end, which `simulate_batch` gives on request."""

ENERGY: Final[tuple[Quantity, ...]] = (
    Quantity("energy.kinetic_start", "E_k,0", "J", "kinetic energy at release"),
    Quantity("energy.kinetic_end", "E_k", "J", "kinetic energy at the end"),
    Quantity("energy.spring_start", "E_s,0", "J", "energy in the spring at release"),
    Quantity("energy.spring_end", "E_s", "J", "energy in the spring at the end"),
    Quantity("energy.skin_start", "E_f,0", "J", "energy in a compliant finger at release"),
    Quantity("energy.skin_end", "E_f", "J", "energy in a compliant finger at the end"),
    Quantity("energy.stop_start", "E_x,0", "J", "energy in elastic end stops at release"),
    Quantity("energy.stop_end", "E_x", "J", "energy in elastic end stops at the end"),
    Quantity("energy.plate_work", "W_in", "J", "work of the moving plate"),
    Quantity("energy.inertia_work", "W_a", "J", "work of the accelerating housing"),
    Quantity("energy.force_work", "W_e", "J", "work of the external force"),
    Quantity("energy.damper_dissipated", "W_b", "J", "energy turned into heat in the damper"),
    Quantity("energy.plate_dissipated", "W_p", "J", "energy turned into heat at the plate"),
    Quantity("energy.finger_dissipated", "W_f", "J", "energy turned into heat at the finger"),
    Quantity("energy.stop_dissipated", "W_x", "J", "energy turned into heat at the end stops"),
    Quantity(
        "energy.skin_dissipated", "W_s", "J", "energy turned into heat in the damper of the skin"
    ),
    Quantity("energy.residual", "W_res", "J", "residual of the energy balance: rounding alone"),
)
"""The energy ledger of a motion."""

CERTIFICATE: Final[tuple[Quantity, ...]] = (
    Quantity("certificate.motion_law", "r_a", "1", "equation of motion between events"),
    Quantity("certificate.kinematics", "r_v", "1", "velocity is the rate of position"),
    Quantity("certificate.friction_law", "r_k", "1", "kinetic friction where a contact slides"),
    Quantity("certificate.force_bound", "r_F", "1", "friction within its bounds"),
    Quantity("certificate.sliding_sign", "r_s", "1", "friction opposes sliding"),
    Quantity("certificate.sticking", "r_0", "1", "a stuck contact does not slide"),
    Quantity("certificate.continuity", "r_c", "1", "position and velocity without jumps"),
    Quantity("certificate.transitions", "r_t", "1", "slips from rest only where it cannot stick"),
    Quantity("certificate.energy", "r_E", "1", "the energy ledger closes"),
    Quantity("certificate.dissipation", "r_D", "1", "friction and damper never add energy"),
    Quantity("certificate.period", "r_T", "1", "a steady motion repeats after its period"),
    Quantity("certificate.steady_since", "r_S", "1", "the motion did not repeat earlier"),
)
"""The largest residual of each law, relative to the size of its terms."""

OUTPUTS: Final[tuple[Quantity, ...]] = TRANSIENT + ENDING + ENERGY + CERTIFICATE

RATE: Final = Quantity(
    "rate",
    "f",
    "Hz",
    "sampling rate of a motion in a file",
    source="assumed",
    absent=1000.0,
    bounds=between(1e-6, 1e12),
)
"""Sampling rate of time series in files."""

MOTION: Final[tuple[Quantity, ...]] = (
    Quantity("time", "t", "s", "time since the release"),
    Quantity("position", "x", "m", "deflection of the pin from the spring's rest"),
    Quantity("velocity", "x'", "m/s", "velocity of the pin in the housing"),
    Quantity("acceleration", "x''", "m/s^2", "acceleration of the pin in the housing"),
    Quantity("plate_force", "R_p", "N", "friction force of the plate on the pin"),
    Quantity("finger_force", "R_f", "N", "friction force of the finger on the pin"),
    Quantity("housing_force", "H", "N", "force of the pin on the housing and the finger"),
    Quantity("stop_force", "R_s", "N", "force of the end stops on the pin"),
    Quantity("stretch", "s", "m", "stretch of the finger's skin"),
    Quantity("stretch_rate", "s'", "m/s", "stretch rate of the skin"),
    Quantity("plate_velocity", "v_p", "m/s", "velocity of the plate in the housing"),
)
"""State of a motion at a time."""

SCANNED: Final[tuple[Quantity, ...]] = (
    Quantity("hand_x", "x_h", "m", "place of the hand across the page"),
    Quantity("hand_y", "y_h", "m", "place of the hand down the page"),
    Quantity("hand_force", "H_h", "N", "force of all pins on the hand, against its drive axis"),
    Quantity("hand_deviation", "e_h", "m", "distance of the hand from its intended path"),
    Quantity("touch", "N_f", "N", "touch force of the finger on each pin"),
    Quantity("luminance", "L", "1", "luminance under the pin's spot"),
    Quantity("command", "u", "", "whether the magnet is switched on"),
    Quantity("current", "c", "1", "current in the coil, a part of the full one"),
    Quantity("pull", "P", "N", "pull of the magnet"),
    Quantity("warming", "ΔT", "K", "warming of the magnet above 20 °C"),
)
"""Additional state of a scan at a time, on the clock of the hand's path."""

SERIES: Final[dict[str, Quantity]] = {quantity.name: quantity for quantity in (*MOTION, *SCANNED)}
"""The columns over time of files and datasets, by their names."""

CHANNELS: Final[dict[str, Quantity]] = {
    **{name: SERIES[name] for name in ("position", "velocity", "acceleration")},
    "force": Quantity("force", "R", "N", "friction force of both contacts on the pin"),
}
"""Columns of a recording of a release."""

# ---- scans ------------------------------------------------------------------------------------

GLEESON: Final = "Gleeson, Horschel & Provancher: direction of tangential motion of skin"
HANDS: Final = "hand speed in finger studies, 20-100 mm/s (arXiv 2505.11162)"

CRITERIA: Final = inputs(
    "criteria",
    Quantity(
        "felt",
        "d_1",
        "m",
        "smallest motion that is felt as a pulse",
        45e-6,
        "9-45 µm at 20-150 Hz on glabrous skin, the upper end "
        "(Hämäläinen & Järvilehto 1981, Brain Res. 219:1)",
    ),
    Quantity(
        "direction",
        "d_2",
        "m",
        "smallest skin motion with a perceived direction",
        5e-5,
        f"{GLEESON}, from 0.05 mm",
    ),
    Quantity(
        "direction_sure",
        "d_3",
        "m",
        "smallest skin motion whose direction is recognised in more than 95 % of cases",
        2e-4,
        f"{GLEESON}, 0.2 mm",
    ),
    Quantity(
        "direction_speed",
        "v_3",
        "m/s",
        "least mean speed of that motion",
        2e-3,
        f"{GLEESON}, 2 mm/s",
    ),
    Quantity(
        "false_line",
        "h_e",
        "1",
        "least height of a false line over that of the line before",
        0.5,
        "assumed",
    ),
    Quantity(
        "distinct",
        "r",
        "1",
        "least return of the pin between two distinct lines, over its way back to the rest",
        0.25,
        "amplitudes of motion at the fingertip are told apart from 2.2-2.5 dB on, which is 22-25 % "
        "(2-200 Hz; Israr & Tan 2006, 10.1109/HAPTIC.2006.1627110)",
    ),
)
"""Criteria of the evaluation of a scan: a table of a device file."""

_FOUND: Final = (
    ("latency_on", "t_l,on", "s", "delay from the first edge of a line to the motion of the pin"),
    ("latency_off", "t_l,off", "s", "delay from the last edge of a line to the return of the pin"),
    ("lag_on", "l_on", "m", "path of the hand from the first edge to the motion of the pin"),
    ("lag_off", "l_off", "m", "path of the hand from the last edge to the return of the pin"),
    ("stroke", "h", "m", "displacement of the pin by the line"),
    ("skin_on", "d_on", "m", "skin motion at the begin of the line"),
    ("skin_off", "d_off", "m", "skin motion at the end of the line"),
    ("smear_time", "t_s", "s", "settling time of the pin after its release"),
    ("smear", "l_s", "m", "path of the hand during the settling: the smear"),
    ("overshoot", "o", "1", "overshoot beyond the rest position, over the displacement"),
    ("contrast", "C", "1", "contrast of crest P and trough T, (P - T) / (|P| + |T|)"),
)

LINE: Final[tuple[Quantity, ...]] = tuple(
    Quantity(f"line.{name}", symbol, unit, meaning) for name, symbol, unit, meaning in _FOUND
)
"""Numbers of each line under each pin."""

EDGES: Final[tuple[Quantity, ...]] = tuple(
    Quantity(
        f"{end}.{name}", symbol, unit, f"{meaning} the {end} of the line passed under the spot"
    )
    for end in ("begin", "end")
    for name, symbol, unit, meaning in (
        ("time", "t", "s", "when"),
        ("x", "x", "m", "where across the page"),
        ("y", "y", "m", "where down the page"),
    )
)
"""Time and place of the edges of a line."""

BAD_WHEN_SMALL: Final = ("stroke", "skin_on", "skin_off", "contrast")
"""Numbers of a line, by their last parts, whose worst value is the least."""


def last_part(quantity: Quantity) -> str:
    """The last part of the name of a line's number."""
    return quantity.name.partition(".")[2]


LINE_COUNTS: Final[tuple[Quantity, ...]] = tuple(
    Quantity(f"lines.{name}", symbol, "", meaning)
    for name, symbol, meaning in (
        ("crossed", "n", "printed lines that passed whole under a pin, counted under each pin"),
        ("shown", "n_1", "shown: the pin moved along, and the skin moved enough to be felt"),
        ("unseen", "n_2", "missed: the control block did not see them"),
        ("merged", "n_3", "missed: magnet or pin had not returned from the line before"),
        ("faint", "n_4", "missed: the pin did not move along, or the skin moved too little"),
        ("false", "n_5", "false: forward swings without a magnet, felt like a line"),
        ("unsettled", "n_6", "shown, but not settled before the next line or the stop of the hand"),
        ("direction", "n_7", "shown, with a perceived direction"),
        ("sure", "n_8", "shown, with a direction recognised in 95 % of cases"),
    )
)
"""Counts of the evaluation of a scan."""

SPEED: Final[tuple[Quantity, ...]] = (
    Quantity("speed.pitch", "p", "m", "distance between two lines", bounds=between(1e-6, 10.0)),
    Quantity("speed.width", "w", "m", "width of the lines", bounds=between(1e-7, 10.0)),
    Quantity(
        "speed.slowest",
        "v_min",
        "m/s",
        "slowest hand tried",
        source=f"a fourth of the slowest of {HANDS}",
        absent=0.005,
        bounds=between(1e-4, 100.0),
    ),
    Quantity(
        "speed.fastest",
        "v_max",
        "m/s",
        "fastest hand tried",
        source=f"ten times the fastest of {HANDS}",
        absent=1.0,
        bounds=between(1e-4, 100.0),
    ),
    Quantity("speed.distinct", "v_d", "m/s", "largest hand speed at which the lines are distinct"),
    Quantity(
        "speed.settled",
        "v_s",
        "m/s",
        "largest hand speed at which the pin also settles between the lines",
    ),
    Quantity(
        "speed.alone",
        "v_0",
        "m/s",
        "largest hand speed of drive and finger alone, with an ideal control block",
    ),
)
"""Quantities of the search for the largest hand speed."""

HAND_PATH: Final[tuple[Quantity, ...]] = (
    Quantity(
        "hand.slowest_speed",
        "v_h",
        "m/s",
        "least speed of a hand that gives way, where half its largest or more is intended",
    ),
    Quantity("hand.mean_speed", "v_m", "m/s", "mean speed of that hand, likewise"),
    Quantity("hand.path_error", "e_h", "m", "largest distance of that hand from its path"),
    Quantity("hand.stopped", "T_s", "s", "total time for which that hand stood or went back"),
)
"""Numbers of the path of a hand that gives way to its pins."""

JUDGE: Final = LINE + LINE_COUNTS + SPEED + HAND_PATH
"""Results of scans and speeds."""

DESIGNED: Final[tuple[Quantity, ...]] = (
    Quantity(
        "design.price",
        "P",
        "1",
        "total price of the catalogue parts of a design",
        bounds=NON_NEGATIVE,
    ),
    Quantity(
        "design.yield",
        "Y",
        "1",
        "part of the devices within tolerances that meets all constraints",
        bounds=between(0.0, 1.0),
    ),
    Quantity(
        "design.distinct_speed",
        "v_d",
        "m/s",
        "largest hand speed at which all lines of a grating are distinct",
    ),
)
"""Numbers of a design beside the numbers of its motions and scans."""
