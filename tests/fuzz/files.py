"""Fuzz of device files, studies and options at their extremes.

python tests/fuzz/files.py COUNT SEED            so many cases of a seed, one after the other
python tests/fuzz/files.py 1 SEED --from NUMBER  one of them again; its files stay in ./case-NUMBER

Every key of the table of quantities has its turn, alone and beside others, at its bounds, beyond
them and between. A case is one command over files made of such values. It must end by itself within
60 s and 4 GB, with status 0, or with status 2 and a few lines that say why, without a traceback or
a warning of a library; some are ended by Ctrl-C, within 2 s, with status 130. None leaves a half
file. Each runs in a fork of this process, which has imported everything already.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import fuzz_cases
from fuzz_cases import Case

SECONDS = 60.0
BYTES = 4 << 30
ADDRESSES = 8 << 30
"""Limit of virtual memory: allocations beyond fail, so that the machine stays usable."""
CTRL_C = 2.0
"""Seconds in which Ctrl-C ends a command; on a machine at its limit some more."""
PATIENCE = 4.0
LINES = 12
"""Longest error message in lines: a file may have several errors."""
WIDTH = 500
"""Longest line of an error message."""


@dataclass
class Result:
    """Result of a case."""

    number: int
    status: int | None
    """None: it was ended, after `SECONDS`."""
    seconds: float
    processor: float
    memory: int
    interrupted: bool
    said: str
    left: list[str] = field(default_factory=list)

    @property
    def wrong(self) -> str:
        """Return the error of the result in a few words; "" without one."""
        if self.status is None:
            return "hangs" if self.interrupted else f"takes more than {SECONDS:g} s"
        if self.status not in ((0, 2, 130) if self.interrupted else (0, 2)):
            return f"ends with status {self.status}"
        if "Traceback" in self.said:
            return "traceback"
        if "Warning" in self.said:
            return "a library warns"
        if self.memory > BYTES:
            return f"takes {self.memory / 1e9:.1f} GB"
        if self.left:
            return f"leaves {', '.join(self.left)}"
        lines = self.said.splitlines()
        if self.status == 2 and not 1 <= len(lines) <= LINES:
            return f"refuses in {len(lines)} lines"
        if self.status == 2 and max(map(len, lines)) > WIDTH:
            return "refuses in a line of endless length"
        return ""


def follow(case: Case, folder: Path) -> Result:
    """Run a case in a folder of its own, in a fork of this process."""
    for name, content in case.files.items():
        (folder / name).write_text(content, encoding="utf-8")
    given = set(os.listdir(folder))
    out, err = folder / ".out", folder / ".err"
    begun = time.monotonic()
    child = os.fork()
    if not child:
        _run(case, folder, out, err)
    status, used = _wait(child, begun, case.interrupt)
    seconds = time.monotonic() - begun
    left = [
        name
        for name in sorted(set(os.listdir(folder)) - given - {".out", ".err"})
        if name.endswith(".part") or (status == 2 and not name.startswith("."))
    ]
    return Result(
        case.number,
        status,
        seconds,
        used.ru_utime + used.ru_stime,
        used.ru_maxrss * 1024,
        case.interrupt is not None,
        err.read_text(encoding="utf-8", errors="replace") if err.exists() else "",
        left,
    )


def _run(case: Case, folder: Path, out: Path, err: Path) -> None:
    """The child: the command line in its folder; never returns."""
    status = 70
    try:
        os.setpgid(0, 0)
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.chdir(folder)
        for stream, path in ((sys.stdout, out), (sys.stderr, err)):
            stream.flush()
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT), stream.fileno())
        sys.argv = ["pindrive", *case.command]
        from pindrive.__main__ import main

        try:
            main()
            status = 0
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else int(end.code is not None)
        except BaseException:
            import traceback

            traceback.print_exc()
            status = 1
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        os._exit(status)


def _wait(
    child: int, begun: float, interrupt: float | None
) -> tuple[int | None, resource.struct_rusage]:
    """The status of a child, None if it had to be killed, and what it used."""
    sent = False
    while True:
        found, status, used = os.wait4(child, os.WNOHANG)
        if found:
            return os.waitstatus_to_exitcode(status), used
        lasts = time.monotonic() - begun
        if interrupt is not None and not sent and lasts >= interrupt:
            os.kill(child, signal.SIGINT)
            sent = True
        limit = interrupt + CTRL_C + PATIENCE if interrupt is not None else SECONDS
        if lasts > limit:
            os.killpg(child, signal.SIGKILL)
            _, _, used = os.wait4(child, 0)
            return None, used
        time.sleep(0.002 if lasts < 0.2 else 0.02)


def main() -> int:
    """Run the cases, say what was found; status 1 if anything was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("--from", dest="first", type=int, default=0)
    options = parser.parse_args()
    fuzz_cases.warm_up()
    totals: Counter[str] = Counter()
    keys: Counter[str] = Counter()
    slowest = largest = longest_stop = None
    wrong = 0
    for number in range(options.first, options.first + options.count):
        case = Case.of(options.seed, number)
        keys.update(case.keys)
        with tempfile.TemporaryDirectory() as place:
            result = follow(case, Path(place))
            if options.count == 1:
                kept = Path(f"case-{number}")
                shutil.rmtree(kept, ignore_errors=True)
                shutil.copytree(place, kept)
                print(" ".join(case.command), "->", result.status, f"{result.seconds:.1f} s")
                print(result.said[:4000], end="")
        totals[case.command[0]] += 1
        totals[{0: "ran", 2: "refused", 130: "interrupted"}.get(result.status or 0, "failed")] += 1
        if slowest is None or result.seconds > slowest.seconds:
            slowest = result
        if largest is None or result.memory > largest.memory:
            largest = result
        if case.interrupt is not None and result.status == 130:
            took = result.seconds - case.interrupt
            longest_stop = max(longest_stop or 0.0, took)
        if result.wrong:
            wrong += 1
            print(f"case {number}: {result.wrong}: pindrive {' '.join(case.command)[:150]}")
            print(f"    {case.drawn}"[:300])
            print("    " + "\n    ".join(result.said.splitlines()[-3:])[:600], flush=True)
    assert slowest and largest
    print(
        f"{options.count} cases of seed {options.seed} from {options.first} on, {len(keys)} of "
        f"{len(fuzz_cases.KEYS)} keys: {totals['ran']} ran, {totals['refused']} refused, "
        f"{totals['interrupted']} interrupted, {wrong} wrong"
    )
    print(", ".join(f"{name} {totals[name]}" for name in fuzz_cases.COMMANDS))
    print(
        f"slowest {slowest.seconds:.1f} s ({slowest.processor:.1f} s of a processor; case "
        f"{slowest.number}), largest {largest.memory / 1e6:.0f} MB (case {largest.number})"
        + (f", Ctrl-C after {longest_stop:.2f} s at most" if longest_stop is not None else "")
    )
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
