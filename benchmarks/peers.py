"""Time and error of a transient by pindrive and by its peers, against thirty-digit answers.

All follow the same drives, drawn as in racing/releases.py, for 0.3 s from the carried state, and
give the position at 76 times, every 4 ms. The error is the largest |x - x_exact| over these, as a
part of the release displacement; of `simulate_batch`, which keeps numbers instead of positions, it
is that of the largest and the smallest position. A drive fails if it does not finish, takes more
than 2 s or 1000 slides, or ends farther than 5 % of the displacement from where it should.

Times are processor time on one thread, from the seven numbers of a drive to its positions; what can
be made once for all drives is made before. The laps go by turns, so that whatever else the machine
does falls on all alike, and the median lap counts. Each peer is used as its own documentation
advises; how, stands at the head of its file in racing/, and `--tried` runs what else was tried:

- SciPy: friction smoothed by a tanh (LSODA, the fastest of its stiff solvers here, with the
  Jacobian), and explicit modes with events (DOP853 and LSODA; steps up to a part of
  the period T; without such a limit a short slide fits into one step and it chatters).
- SUNDIALS: CVODE's Adams method, explicit modes with its root functions.
- MuJoCo: frictionloss of a joint and of a tendon, as hard as it can be (impedance 0.9999, twice the
  time step), the solver's tolerance 0; and with the values that it has of its own.
- numba: a set-valued Moreau-Jean stepper, in closed form, compiled.
- PathSim: zero-crossing events that switch modes, RKCK54.
- Siconos: EulerMoreauOSI(0.5) with a relay on each contact. `--siconos` names a Python that has it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from datetime import date
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.racing.race import TIMES, Racer, Result, race
from benchmarks.racing.releases import columns, drawn, exact_positions

ALWAYS = ("pindrive", "scipy")  # which machine() names
# Peer: the module that it needs, its distribution, and ours that uses it.
PEERS = {
    "pindrive": ("pindrive", "pindrive", "with_pindrive"),
    "numba": ("numba", "numba", "with_numba"),
    "SciPy": ("scipy", "scipy", "with_scipy"),
    "SUNDIALS": ("sksundae", "scikit-sundae", "with_sundials"),
    "MuJoCo": ("mujoco", "mujoco", "with_mujoco"),
    "PathSim": ("pathsim", "pathsim", "with_pathsim"),
}


def entered(
    tried: bool, siconos: str | None, only: list[str], absent: list[str]
) -> Iterator[Racer]:
    """All racers; `absent` gets the peers that are not installed."""
    for peer, (module, _, ours) in PEERS.items():
        if only and peer not in only:
            continue
        if find_spec(module) is None:
            absent.append(peer)
        else:
            yield from import_module(f"benchmarks.racing.{ours}").racers(tried)
    if not only or "Siconos" in only:
        from benchmarks.racing import with_siconos

        program = with_siconos.python(siconos)
        if program is None and siconos:
            raise ValueError(f"--siconos: {siconos!r} is no Python that has siconos.kernel")
        if program is None:
            absent.append("Siconos")
        else:
            yield from with_siconos.racers(program, tried)


def versions(absent: list[str]) -> str:
    """Peers that took part."""
    names = [name for peer, (_, name, _) in PEERS.items() if peer not in absent]
    return ", ".join(f"{name} {version(name)}" for name in names if name not in ALWAYS)


def amount(seconds: float) -> str:
    """In µs, with three digits."""
    micros = 1e6 * seconds
    return f"{micros:,.0f}".replace(",", " ") if micros >= 100 else f"{micros:.3g}"


def table(results: list[Result], absent: list[str], count: int) -> Table:
    """A row a setting; failures counted by their kind."""
    shown = Table(box=box.SIMPLE_HEAD)
    for name in ("peer", "way", "setting"):
        shown.add_column(name, no_wrap=True)
    for name in ("µs a\ntransient", "error,\nmedian", "error,\nworst"):
        shown.add_column(name, justify="right", no_wrap=True)
    shown.add_column(f"failed\nof {count}")
    before = ("", "")
    for result in results:
        racer, why = result.racer, list(result.failures.values())
        words = ", ".join(f"{why.count(kind)} {kind}" for kind in sorted(set(why)))
        peer = racer.peer if racer.peer != before[0] else ""
        way = racer.way if (racer.peer, racer.way) != before else ""
        if peer and before[0]:
            shown.add_section()
        before = (racer.peer, racer.way)
        finished = result.errors[np.isfinite(result.errors)]
        errors = (np.median(finished), finished.max()) if len(finished) else ()
        cells = [f"{error:.1e}" for error in errors] or ["", ""]
        shown.add_row(peer, way, racer.setting, amount(result.seconds), *cells, words)
    for peer in absent:
        shown.add_section()
        shown.add_row(peer, "not installed")
    return shown


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=30, help="drives")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--laps", type=int, default=7, help="of which the median counts, at most")
    parser.add_argument("--budget", type=float, default=1.0, help="for more laps of a racer, s")
    parser.add_argument(
        "--only", action="append", default=[], choices=[*PEERS, "Siconos"], help="may be repeated"
    )
    parser.add_argument("--tried", action="store_true", help="whatever else was tried, too")
    parser.add_argument("--siconos", metavar="PYTHON", help="a Python that has Siconos")
    parser.add_argument("--figure", type=Path, help="draw error against time into this file")
    given = parser.parse_args()

    if min(given.count, given.laps) < 1:
        parser.error("--count and --laps must be at least 1")

    from benchmarks.simulate import machine

    console, absent = Console(width=115, highlight=False), list[str]()
    try:
        racers = list(entered(given.tried, given.siconos, given.only, absent))
    except ValueError as error:
        parser.error(str(error))
    drives = columns(drawn(given.count, given.seed))
    with console.status("thirty digits") as status:
        truth = exact_positions(drives, TIMES).astype(np.float64)
        results = race(racers, drives, truth, given.laps, given.budget, status.update)
    what = f"{given.count} drives, seed {given.seed}, 0.3 s"
    console.print(f"{machine()}\n{versions(absent)}\n{what}; {date.today()}")
    console.print(table(results, absent, given.count))
    if given.figure:
        from benchmarks.racing.figure import draw

        where = machine().split("\n")[0]
        draw(results, f"{what} each. {where}, one thread, {date.today()}", given.figure)
        console.print(f"The figure is {given.figure}")


if __name__ == "__main__":
    main()
