"""Ctrl-C: one word, status 130, and no file half written."""

from __future__ import annotations

import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from command import EXAMPLES, taking_ctrl_c

pytestmark = [
    pytest.mark.usefixtures("in_empty_folder"),
    pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT"),
]
MOUSE, READER, STUDY, RECORDING = (
    shlex.quote(str(EXAMPLES / name))
    for name in (
        *("tactile-mouse.toml", "tactile-reader.toml", "tactile-reader-study.toml"),
        "release-recording.csv",
    )
)
LONG = {
    "scan": f"scan {READER} --text 'reads\\nreads' --set array.columns=16 "
    "--set array.rows=16 -o a.nc --plot a.png",
    "speed": f"speed {READER} --plot a.png --slowest 1mm/s",
    "robustness": f"robustness {STUDY} --plot a.png",
    "sensitivity": f"sensitivity {STUDY} --plot a.pdf",
    "fit": f"fit {MOUSE} {RECORDING} "
    "--free stiffness,damping,plate.kinetic,finger.kinetic,displacement,time_offset -o a.toml "
    "--plot a.png",
}


@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_a_command(name: str) -> None:
    """Sent when the file that it is to write has been begun."""
    command = [sys.executable, "-m", "pindrive", *shlex.split(LONG[name])]
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, preexec_fn=taking_ctrl_c
    ) as running:
        while running.poll() is None and not any(Path().iterdir()):
            time.sleep(0.02)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate()
    assert running.returncode == 130, said
    assert said.startswith("stopped") and said.count("\n") == 1
    assert list(Path().iterdir()) == []


PROBLEMS = {
    "motions": "tactile-mouse-problem.toml",
    "scans": "tactile-reader-problem.toml --set control.sample_rate=250Hz",
}
INTERRUPTED = """
import os, signal
from pindrive.cli.app import main
from pindrive.optimisation.designing import _Optimisation

def step(_):
    os.kill(os.getpid(), signal.SIGINT)

_Optimisation.step = step
main()
"""


@pytest.mark.parametrize("name", PROBLEMS)
def test_ctrl_c_ends_a_design(name: str) -> None:
    """Sent between the screening and the search; files are written at the end alone."""
    problem, *options = PROBLEMS[name].split()
    words = ["design", str(EXAMPLES / problem), *options, "-o", "design.toml"]
    ended = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, *words],
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        preexec_fn=taking_ctrl_c,
    )
    assert ended.returncode == 130, ended.stderr
    assert ended.stderr == "stopped; nothing was written\n"
    assert list(Path().iterdir()) == []
