"""Ctrl-C ends whatever runs in the core, however long it would have taken."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

# Calls of the core one after the other for ever, by an iterator in C: between two of them Python
# never looks for a signal, so one of the calls must. The motion has a million events: without
# damping, the weakest friction takes so many half periods to end it.
PROGRAM = """
from collections import deque
from itertools import repeat, starmap
import numpy as np
from pindrive import Contact, Drive, Release, _core, simulate
from pindrive.motion import batch

drive = Drive(mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.0), finger=Contact(1e-9))
motion = simulate(drive, Release(0.06, 0.002))
core, numbers, duration = motion.core, motion.core_numbers, motion.duration
t = np.linspace(0.0, 1.0, 1_000_000)
call, arguments = {call}
print("ready", flush=True)
deque(starmap(call, repeat(arguments)), maxlen=0)
"""
BATCH = (
    "_core.simulate_batch, ([np.broadcast_to(np.array(x), 10**6) for x in (0.01, 100.0, 0.0, 0.0, "
    "0.0, 1e-9, 1e-9, np.inf, 0.06, 0.002, 0.06, np.inf, 0.05, 1.0)], batch._BOUNDS, 3, [], True)"
)
CALLS = {
    "simulate": "_core.simulate, numbers",
    "differentiate": "_core.differentiate, (numbers, numbers)",
    "position": "core.position, (t, True)",
    "force": "core.finger_force, (t, False)",
    "transient": "core.transient, (duration, 0.05)",
    "ledger": "core.ledger, (duration,)",
    "certificate": "core.certificate, (duration,)",
    "simulate_batch": BATCH,
}


@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c_ends_a_call_of_the_core(name: str) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM.format(call=CALLS[name])],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.2)
        os.kill(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert said.splitlines()[-1] == "KeyboardInterrupt", said
