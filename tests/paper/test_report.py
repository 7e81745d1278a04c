"""The report on the paper: each number, verdict and curve in it is computed."""

from __future__ import annotations

import re

import numpy as np
import pytest

from pindrive import Contact, Drive, Profile, Release, simulate, simulate_batch
from pindrive.paper import as_printed, formulas, maps, population
from pindrive.paper.claims_of_analysis import has_closed_form
from pindrive.paper.equations import damping_ratio, where_good
from pindrive.paper.exhibit import at_most, by_case, trend
from pindrive.paper.population import Claim
from pindrive.paper.report import Report
from pindrive.paper.sensitivity import PARAMETERS
from pindrive.paper.wording import listed, share

# ---- what it says --------------------------------------------------------------------------------


def test_the_corrected_equations_are_exact_and_the_printed_ones_not(made: Report) -> None:
    for row in made.rows:
        assert row.off_right < 1e-13, row.number
        if row.number == "10":
            assert np.isnan(row.off_printed), "its units do not agree"
        elif row.right:
            assert row.off_printed > 0.01, row.number
        else:
            assert row.off_printed == row.off_right
    wrong = [row.number for row in made.rows if row.right]
    assert wrong == ["1", "8", "10", "14", "16", "17", "20", "23", "25, 26"]


VERDICTS = {
    "The great variety of tactile systems": "not evaluated",
    "The method, where information": "not evaluated",
    "Electromagnet 1 with wrapped winding": "not evaluated",
    "When the cursor is in the information area": "not evaluated",
    "The pin slides along the fingertip": "not evaluated",
    "The interaction between finger skin": "not evaluated",
    "The experiments have shown that the tactile": "not evaluated",
    "In that case law of motion of the pin": "not evaluated",
    "During the investigation a significant": "not evaluated",
    "The relationship of transitional process": "not evaluated",
    "The mathematical model of the drive of": "not evaluated",
    "The absolutely largest pin velocity": "holds when the pin reaches",
    "The pin will stop and dry friction force": "holds when the pin does not stick",
    "The first friction force direction change": "does not hold",
    "Becomes clear that the analytical solution": "not proved",
    "because nor pin acceleration": "does not hold",
    "It is available only in the limit case": "not proved",
    "For the general case equation (1)": "not proved",
    "Model of tactile device pin interaction": "done here",
    "The law of damped pin motion": "done here",
    "It was defined what initial phase angle": "holds when x_0 > x_d",
    "and φ_0 = 0, when v_p = 0": "holds when the damping is zero",
    "Higher mouse velocity causes greater": "holds",
    "Friction forces are influencing": "does not hold",
    "The greater displacement x_d": "holds",
    "and reducing the amplitude": "holds when x_0 − x_d > −ζ v_p / ω_0",
    "The initial pin displacement x_0": "holds when v_p <",
    "and their damping": "holds when damping means the duration",
    "The results of investigation": "holds when the equations are corrected",
    "For the case when the pin": "holds",
    "which would be stabilized": "does not hold",
    "If the friction between": "holds when x_d is F_f / k",
    "The dynamics of tactile device": "not evaluated",
    "It was defined that the law": "not proved",
    "The model for the pin drive": "done here",
}


def test_every_sentence_has_the_verdict_that_was_derived(made: Report) -> None:
    assert len(made.claims) == len(VERDICTS)
    shown = {*made.exhibits} | {"equations", ""}
    for claim, (start, verdict) in zip(made.claims, VERDICTS.items(), strict=True):
        assert claim.sentence.startswith(start)
        if " when " in verdict:
            assert claim.verdict.startswith(verdict), claim.sentence
        else:
            assert claim.verdict == verdict, claim.sentence
        assert claim.shown_by in shown
        assert (claim.true is None) == (verdict == "not evaluated")
        assert claim.true is None or (claim.true.size > 1 and re.search(r"\d", claim.finding))


def claim(
    true: list[bool] | None,
    meets: list[bool] | None = None,
    *,
    done: bool = False,
    excludes: bool = False,
) -> str:
    trials, condition = (None if x is None else np.array(x) for x in (true, meets))
    return Claim("", "", trials, "", "", "it rains", condition, done, excludes).verdict


def test_a_verdict_follows_from_the_trials() -> None:
    assert claim([True, True]) == "holds"
    assert claim([True, False]) == "does not hold"
    assert claim([True, False], [True, False]) == "holds when it rains"
    assert claim([True, False], [True, True]) == "does not hold"
    assert claim([False, False], [False, False]) == "does not hold"
    assert claim(None) == "not evaluated"
    assert claim([True, True], done=True) == "done here"
    assert claim([True, False], done=True) == "not done here"
    assert claim([True, True], excludes=True) == "not proved"
    assert claim([True, False], [True, False], excludes=True) == "not proved"
    assert claim([True, False], excludes=True) == "does not hold"


def test_a_closed_form_of_the_reversal_is_there_without_damping_and_in_the_limit_alone() -> None:
    damped = population.damped(200)
    damped = damped.take(np.isfinite(formulas.first_reversal_time(damped)))
    assert damped.shape[0] > 40
    assert not has_closed_form(damped).any()
    limit = population.limit_cases(200)
    assert has_closed_form(limit).all()
    assert has_closed_form(limit.replace(damping=0.0)).all()


def test_the_printed_lag_changes_with_the_unit_of_time() -> None:
    """So (10) has no value; the right form has one."""
    m, b, k = 0.01, 0.32, 100.0
    for printed in (True, False):
        lags = []
        for unit in (1.0, 0.1):  # s
            damping, stiffness = b * unit, k * unit**2
            rate = (stiffness / m) ** 0.5 if printed else 1.0
            square = stiffness**2 if printed else m * stiffness
            lags.append(np.arctan(damping * rate / np.sqrt(4 * square - damping**2)))
        assert (abs(lags[1] / lags[0] - 1) > 1e-6) == printed


def test_at_the_plates_velocity_the_pin_passes_or_is_caught(made: Report) -> None:
    (said,) = (c.finding for c in made.claims if c.sentence.startswith("The pin will stop"))
    assert re.findall(r"(\d+) of (\d+)", said) == [("523", "605"), ("82", "605"), ("45", "82")]


def test_range_of_a_printed_form() -> None:
    r = population.damped(400)
    ratio, beyond = damping_ratio(r), r.displacement > formulas.friction_offset(r)
    assert where_good(np.zeros(400), r) == "everywhere (400 of 400)"
    assert where_good(np.where(beyond, 0.0, 3.0), r) == f"x_0 > x_d ({beyond.sum()} of 400)"
    assert where_good(np.where(ratio < 0.25, 0.01, 0.0101), r).startswith("ζ < 0.2")
    assert where_good(np.full(400, -1.0), r) == "nowhere"


def test_the_ranges_of_the_printed_forms(made: Report) -> None:
    """Against the corrected functions, over the damping ratio."""
    of = {row.number: row for row in made.rows}
    r = population.damped()
    ratio, light = damping_ratio(r), damping_ratio(r) <= 0.32
    assert of["8"].good.startswith("x_0 > x_d (1847 ")
    assert "by π to $< 10^{-12}$ where x_0 < x_d" in of["8"].against
    assert of["2"].right == of["2"].good == ""
    assert of["25, 26"].good == "nowhere"
    for number, name in (("14", "peak_displacement"), ("17", "swing")):
        off = getattr(as_printed, name)(r) - getattr(formulas, name)(r)
        off = np.abs(off) / formulas.amplitude(r)
        found = re.fullmatch(r"ζ < ([\d.]+) \((\d+) of 2000; good in all: (\d+)\)", of[number].good)
        assert found is not None
        assert off[ratio < float(found[1])].max() <= 0.01
        assert off[ratio < float(found[1]) + 0.011].max() > 0.01
        assert (ratio < float(found[1])).sum() == int(found[2])
        assert (off <= 0.01).sum() == int(found[3])
        assert of[number].off_printed == pytest.approx(off.max(), rel=1e-9)
        assert of[number].off_lightly_damped == pytest.approx(off[light].max(), rel=1e-9)
    assert of["14"].off_lightly_damped == pytest.approx(0.052, abs=5e-4)


def test_the_ranges_of_the_figure_are_those_of_its_curves(made: Report) -> None:
    """A printed form may be good again beyond a range where it is not, as (16) is."""
    shown = made.exhibits["printed-forms"]
    reported = dict(
        re.findall(
            r"\((\d+)\) ((?:(?: and )?(?:up to|from) ζ = \d\.\d+(?: on)?)+)", shown.readings[1]
        )
    )
    numbers = {"14": "peak_displacement", "16": "trough_displacement", "17": "swing"}
    numbers["20"] = "return_velocity"
    assert reported.keys() == numbers.keys()
    ratio = shown.data.ratio.to_numpy()
    for number, name in numbers.items():
        spans = re.findall(r"(up to|from) ζ = (\d\.\d+)", reported[number])
        near, inside = np.zeros(ratio.shape, dtype=bool), np.zeros(ratio.shape, dtype=bool)
        for word, edge in spans:
            inside |= ratio <= float(edge) if word == "up to" else ratio >= float(edge)
            near |= np.abs(ratio - float(edge)) < 0.0101
        good = shown.data[name].to_numpy() <= 0.01
        assert (good == inside)[~near].all()
        assert good[inside].all()
    assert reported["16"].startswith("up to ζ = 0.1")
    assert reported["16"].endswith(" on")


def test_the_releases_are_those_stated() -> None:
    r = population.damped()
    assert formulas.applies(r).all()
    ratio = r.damping / (2 * np.sqrt(r.mass * r.stiffness))
    for values, low, high in (
        (r.mass, 2e-3, 20e-3),
        (r.stiffness, 20, 400),
        (ratio, 0, 0.97),
        (r.friction, 0, 0.05),
        (r.mouse_velocity, 0, 0.3),
    ):
        assert low <= values.min() < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < values.max() <= high
    assert (population.damped().displacement == r.displacement).all(), "one seed, one set"


def test_the_curves_are_the_simulations(made: Report) -> None:
    """Curves at random places of all eight parameters equal `simulate`."""
    draw = np.random.default_rng(4)
    time, way = (made.exhibits[f"influence-on-{name}"].data for name in ("time", "displacement"))
    base = {"mass": 0.01, "stiffness": 100.0, "damping": 0.32, "plate_kinetic": 0.022,
            "finger_kinetic": 0.005, "mouse_velocity": 0.06, "displacement": 2e-3}  # fmt: skip
    for parameter in PARAMETERS:
        for point in draw.integers(1, time.sizes["point"], 5):
            where = {"parameter": parameter.argument, "point": int(point)}
            at = {"parameter": parameter.argument}
            value = float(time.value.sel(at).isel(point=point))
            p = base | {parameter.argument: value}
            touch = p.get("touch_force", 0.01)
            p["finger_kinetic"] = 0.5 * touch
            p["plate_kinetic"] *= (0.01 * 9.80665 + touch) / (0.01 * 9.80665 + 0.01)
            fall = p.get("fall_time", 0.0)
            drive = Drive(
                mass=p["mass"],
                stiffness=p["stiffness"],
                damping=p["damping"],
                plate=Contact(p["plate_kinetic"]),
                finger=Contact(p["finger_kinetic"]),
            )
            v, x = p["mouse_velocity"], p["displacement"]
            load = Profile([0.0, fall], [12.0, 1.0])
            found = simulate(drive, Release(v, x, plate_load=load))
            shown = time.settling_time.sel(at).isel(point=point)
            assert float(shown) == pytest.approx(found.transient.settling_time, rel=1e-9), where
            peak = way.peak_displacement.sel(at).isel(point=point)
            assert float(peak) == pytest.approx(found.transient.peak_displacement, rel=1e-12)
    for point in draw.integers(0, time.sizes["point"], 5):
        mass = float(time.value.sel(parameter="mass")[point])
        heavy = Drive(
            mass=mass,
            stiffness=100.0,
            damping=0.32,
            plate=Contact(0.022 * (mass * 9.80665 + 0.01) / (0.01 * 9.80665 + 0.01)),
            finger=Contact(0.005),
        )
        numbers = simulate(heavy, Release(0.06, 2e-3)).transient
        shown = float(time.settling_time_by_weight[point])
        assert shown == pytest.approx(numbers.settling_time, rel=1e-9)
        shown = float(way.peak_displacement_by_weight[point])
        assert shown == pytest.approx(numbers.peak_displacement, rel=1e-9)


def test_load_and_fall_of_the_pull(made: Report) -> None:
    """A heavier finger ends it sooner; a slower fall releases later and farther out."""
    time, way = (made.exhibits[f"influence-on-{name}"].data for name in ("time", "displacement"))
    touch, fall = ({"parameter": name} for name in ("touch_force", "fall_time"))
    assert trend(time.settling_time.sel(touch)).startswith("falls on the whole")
    assert trend(way.peak_displacement.sel(touch)) == "falls throughout"
    assert trend(time.settling_time.sel(fall)) == trend(way.peak_displacement.sel(fall))
    late = way.peak_displacement.sel(fall)
    carried = 0.06 * 0.03  # how far the plate moves while the pull falls
    assert 0.0 < float(late[-1] - late[0]) < carried
    for e in ("time", "displacement"):
        rows = [row[0] for row in made.exhibits[f"influence-on-{e}"].table]
        assert "mass, friction follows the weight" in rows


def test_what_the_share_of_the_touch_changes() -> None:
    """The figures of the sentence on the supporting surface."""
    touches = np.linspace(1e-3, 0.04, 40)
    times, ways = [], []
    for part in (0.0, 1.0):
        coefficient = 0.022 / (0.01 * 9.80665 + part * 0.01)
        pressed = Drive(
            mass=0.01,
            stiffness=100.0,
            damping=0.32,
            plate=Contact(coefficient=coefficient),
            finger=Contact(coefficient=0.5),
            touch_force=0.01,
            touch_share=part,
        )
        found = simulate_batch(pressed, Release(0.06, 2e-3), touch_force=touches)
        times.append(found.transient_settling_time.to_numpy())
        ways.append(found.transient_peak_displacement.to_numpy())
    assert np.abs(times[0] / times[1] - 1.0).max() == pytest.approx(0.09, abs=0.01)
    assert np.abs(ways[0] / ways[1] - 1.0).max() == pytest.approx(0.0011, abs=1e-4)


def test_the_maps_are_the_simulations(made: Report) -> None:
    """At random places, in units of another mass, length and time."""
    draw = np.random.default_rng(5)
    data = made.exhibits["maps-of-time"].data
    m, k, x0 = 0.007, 130.0, 1.3e-3
    w0 = (k / m) ** 0.5
    for across, up in maps.TIME_MAPS:
        key = f"{across}_{up}"
        for i, j in draw.integers(0, maps.POINTS, (6, 2)):
            groups = {name: group.baseline for name, group in maps.GROUPS.items()}
            groups[across] = float(data[f"{key}_{across}"][i])
            groups[up] = float(data[f"{key}_{up}"][j])
            drive = Drive(
                mass=m,
                stiffness=k,
                damping_ratio=groups["damping"],
                plate=Contact(groups["plate"] * k * x0),
                finger=Contact(groups["finger"] * k * x0),
            )
            v = groups["speed"] * w0 * x0
            found = simulate(drive, Release(v, x0)).transient.settling_time
            periods = float(data[f"{key}_periods"][j, i])
            assert w0 * found / (2 * np.pi) == pytest.approx(periods, rel=1e-8, abs=1e-12)


# ---- words ---------------------------------------------------------------------------------------


def test_trends() -> None:
    assert trend([1, 2, 2, 3]) == "rises throughout"
    assert trend([3, 1]) == "falls throughout"
    assert trend([1, 2, 3, 2.9, 4]) == "rises on the whole (rank correlation 0.90)"
    assert trend([4, 3, 1, 2, 0]) == "falls on the whole (rank correlation −0.90)"
    assert trend([1, 0, 1.5, 0.5]) == "goes up and down"


def test_words_of_numbers() -> None:
    assert at_most(4e-16) == "< 10^{-12}"
    assert at_most(9e-14) == "< 10^{-12}"
    assert at_most(2e-13) == "< 10^{-9}"
    assert at_most(0.0) == "0"
    assert share([True, False, True]) == "2 of 3"
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert listed(["a"]) == "a"
    assert by_case({"1": "rises", "3": "falls", "2": "rises"}) == "rises at 1 and 2, falls at 3"
