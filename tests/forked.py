"""Runs tests in forks of a process that has loaded the libraries, on a package that it is told of.

Reads jobs, a line of JSON each: `path`, where the package is, `module`, one of it that must be
importable, `tests` and `limit` in seconds. Writes for each a line of JSON: pytest's exit status (-1
where the tests did not end in time, `NOT_IMPORTED` where the module cannot be imported), and the
line of the output that says most.
"""

from __future__ import annotations

import importlib
import json
import os
import signal
import sys
import tempfile
import time
from contextlib import suppress
from typing import Any, NoReturn

LOADED = (
    *("_pytest.assertion.rewrite", "pytest", "numpy", "xarray", "h5netcdf", "h5py"),
    *("scipy.stats", "scipy.signal", "scipy.optimize", "matplotlib.figure", "matplotlib.pyplot"),
    *("rich.console", "rich.table", "typer.testing", "pint", "PIL.Image"),
)
"""Modules that most tests import and the package does not change."""
NOT_IMPORTED = -2
OPTIONS = ("-x", "-q", "-n", "0", "--no-header", "--tb=no", "-p", "no:cacheprovider")


def without_editable() -> list[Any]:
    """The finders of modules but that of an editable installation, which goes before all paths."""
    return [one for one in sys.meta_path if not type(one).__module__.startswith("_editable_")]


def work(job: dict[str, Any]) -> NoReturn:
    """Runs the tests in this process, which ends with them."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    sys.meta_path = without_editable()
    sys.path.insert(0, job["path"])
    os.environ["PYTHONPATH"] = job["path"]  # of what the tests start
    status = NOT_IMPORTED
    try:
        importlib.import_module(job["module"])
        import pytest

        status = int(pytest.main([*OPTIONS, *job["tests"]]))
    except BaseException as error:
        print(f"{type(error).__name__}: {error}")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status & 0xFF)


def ended(child: int, limit: float) -> int | None:
    """The exit status of a child; None where it had to be ended, with all that it started."""
    until = time.monotonic() + limit
    try:
        while time.monotonic() < until:
            done, status = os.waitpid(child, os.WNOHANG)
            if done:
                return os.waitstatus_to_exitcode(status)
            time.sleep(0.01)
    except SystemExit:
        os.killpg(child, signal.SIGKILL)
        raise
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


def telling(output: str) -> str:
    """The line that says most."""
    lines = [line for line in output.splitlines() if line.strip()] or [""]
    return ([line for line in lines if line.startswith(("FAILED", "ERROR"))] or lines[-1:])[0]


def answer(job: dict[str, Any]) -> dict[str, Any]:
    """Return the result of a job."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
        child = os.fork()
        if not child:
            os.setpgid(0, 0)
            os.dup2(output.fileno(), 1)
            os.dup2(output.fileno(), 2)
            work(job)
        with suppress(OSError):  # done by the child, or the child has ended
            os.setpgid(child, child)
        status = ended(child, job["limit"])
        output.seek(0)
        said = telling(output.read())
    if status is None:
        return {"status": -1, "said": "does not end"}
    return {"status": NOT_IMPORTED if status == NOT_IMPORTED & 0xFF else status, "said": said}


def main() -> None:
    """Run jobs in sequence until there are none."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    for name in LOADED:
        importlib.import_module(name)
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
