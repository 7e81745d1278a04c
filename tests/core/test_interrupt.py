"""Ctrl-C ends each call that can last, however long it would have taken."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SETUP = f"""
import os
os.chdir({str(ROOT / "examples")!r})
from collections import deque
from itertools import repeat, starmap
import numpy as np
import pindrive as pd
from pindrive import _core
from pindrive.motion import batch

absent = pd.Contact(0.0)

def body(**given):
    return pd.Drive(**{{"mass": 0.01, "stiffness": 100.0, "damping": 0.0, "plate": absent,
                       "finger": absent, **given}})

def long():
    '''A million half periods: the weakest friction takes so many to end an undamped motion.'''
    return pd.simulate(body(finger=pd.Contact(1e-9)), pd.Release(0.06, 0.002))

def cycle():
    '''A steady motion that is known for ever, of 1e10 s.'''
    return pd.simulate(body(plate=pd.Contact(0.1, 0.2)), pd.Release(0.06), duration=1e10)

def driven():
    '''A response under a function, in many segments.'''
    push = pd.harmonic(0.0, 0.5, 7.0) + pd.harmonic(0.0, 0.5, 2.0**0.5)
    drive = body(damping=0.02, finger=pd.Contact(0.3), plate=pd.Contact(0.1))
    return pd.simulate(drive, pd.Release(0.06, force=push), duration=1500.0)
"""
CORE = """
motion = long()
core, numbers, duration = motion.core, motion.core_numbers, motion.duration
t = np.linspace(0.0, 1.0, 1_000_000)
call, arguments = {call}
print("ready", flush=True)
deque(starmap(call, repeat(arguments)), maxlen=0)
"""
# An iterator in C repeats the call without end: between two calls Python does not check for a
# signal, so that one of the calls must.
BATCH = (
    "_core.simulate_batch, ([np.broadcast_to(np.array(x), 10**6) for x in (0.01, 100.0, 0.0, 0.0, "
    "0.0, 1e-9, 1e-9, np.inf, 0.06, 0.002, 0.06, np.inf, 0.05, 1.0)], batch._BOUNDS, 3, [], True)"
)
CALLS = {
    "simulate": "_core.simulate, numbers",
    "differentiate": "_core.differentiate, (numbers, numbers)",
    "position": "core.position, (t, True)",
    "force": "core.finger_force, (t, False)",
    "columns": "core.columns, (t, True)",
    "transient": "core.transient, (duration, 0.05)",
    "ledger": "core.ledger, (duration,)",
    "certificate": "core.certificate, (duration,)",
    "crossings": "core.crossings, (0, 1.0, duration, 10)",
    "extrema": "core.extrema, (1, duration, 10**9)",
    "segments": "core.segments, ()",
    "function_at": "_core.function_at, (pd.harmonic(0.0, 1.0, 7.0).core, t)",
    "simulate_batch": BATCH,
}
PUBLIC = """
{make}
print("ready", flush=True)
while True:
    {call}
"""
DRIVE = "drive, release = body(finger=pd.Contact(1e-9)), pd.Release(0.06, 0.002)"
MOUSE = "mouse = pd.load_device('tactile-mouse.toml')"
PUBLIC_CALLS = {
    "simulate": (DRIVE, "pd.simulate(drive, release)"),
    "simulate without an end": (
        "drive = body(stiffness=1e-9, finger=pd.Contact(0.01))\npush = pd.harmonic(0.0, 0.02, 1.0)",
        "pd.simulate(drive, pd.Release(0.0, force=push), duration=1e9)",
    ),
    "simulate_batch": (
        DRIVE,
        "pd.simulate_batch(drive, release, damping=np.linspace(0.0, 1e-9, 100_000))",
    ),
    "bifurcation": ("study = pd.load_study('belt-study.toml')", "pd.bifurcation(study)"),
    "study": ("study = pd.load_study('tactile-mouse-study.toml')", "study.run()"),
    "robustness": (
        "study = pd.load_study('tactile-mouse-study.toml')",
        "pd.robustness(study, count=1 << 20)",
    ),
    "sobol": ("study = pd.load_study('tactile-mouse-study.toml')", "pd.sobol(study)"),
    "optimise": ("", "pd.optimise(None, 'tactile-mouse-problem.toml')"),
    "local_sensitivity": (
        "study = pd.load_study('tactile-mouse-study.toml')",
        "pd.local_sensitivity(study)",
    ),
    "speed limit": (
        f"{MOUSE}\nfrom pindrive.evaluation.resolution import largest_speeds",
        "largest_speeds(mouse.device, [0.004] * 50)",
    ),
    "scan": (MOUSE, "pd.scan(mouse, pd.Page(grating=['4 mm']))"),
    "evaluation": (
        f"{MOUSE}\nscan = pd.scan(mouse, pd.Page(grating=['4 mm']))",
        "scan.evaluate(); scan.to_dataset()",
    ),
    "fit": (
        """recording = pd.read_recording('release-recording.csv')
drive = pd.Drive(mass=0.01, stiffness=100.0, damping=0.2, plate=absent, finger=pd.Contact(0.02))""",
        "pd.fit(recording, drive, pd.Release(0.06, 0.001), free=['stiffness', 'finger.kinetic'])",
    ),
    **{
        name: ("motion = driven()", f"pd.Motion.{call}")
        for name, call in {
            "events": "events.func(motion)",
            "segments": "segments.func(motion)",
            "transient": "_numbers.func(motion)",
            "energy": "_energy.func(motion)",
            "certificate": "certificate(motion)",
            "extrema": "extrema(motion, 'velocity')",
            "columns": "columns(motion, np.linspace(0.0, 1500.0, 100_000))",
            "to_dataset": "to_dataset(motion)",
            "sensitivity": "sensitivity(motion, ['mass', 'damping']).numbers",
        }.items()
    },
    "crossings of a cycle": ("motion = cycle()", "motion.crossings('position', 1.0)"),
    "events of a cycle": ("motion = cycle()", "motion.events_between(1.0, 1.5e5)"),
    "settling time": ("motion = long()", "motion.settling_time(0.02)"),
}


def interrupt(program: str) -> str:
    """Return what a program writes that is interrupted after its line "ready"."""
    process = subprocess.Popen(
        [sys.executable, "-W", "ignore", "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout
        first = process.stdout.readline()
        assert first == "ready\n", process.communicate()[1]
        time.sleep(0.3)
        os.kill(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    return said


@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c_ends_a_call_of_the_core(name: str) -> None:
    said = interrupt(SETUP + CORE.format(call=CALLS[name]))
    assert said.splitlines()[-1] == "KeyboardInterrupt", said


@pytest.mark.parametrize("name", PUBLIC_CALLS)
def test_ctrl_c_ends_a_public_call(name: str) -> None:
    make, call = PUBLIC_CALLS[name]
    said = interrupt(SETUP + PUBLIC.format(make=make, call=call))
    assert said.splitlines()[-1] == "KeyboardInterrupt", said
