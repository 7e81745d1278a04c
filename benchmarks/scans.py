"""Processor time of scans with their evaluation, stage by stage, and of a study of scans.

Cases are the reader of examples/tactile-reader.toml over three gratings and over two lines of text,
and over the gratings with the drive at 0.15 rad to the hand; stages are reading and switching, the
motions, and the evaluation. A study of scans is timed with one thread and with two, and a
millisecond of sixteen pins under a hand that is given as it moves, through C.

`--against COMMIT` builds that commit beside this one and times the same cases by turns.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tarfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from io import BytesIO
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from typing import Any

import pindrive

ROOT = Path(__file__).resolve().parent.parent
READER = ROOT / "examples" / "tactile-reader.toml"
STUDY = ROOT / "examples" / "tactile-reader-study.toml"
GRATINGS = ["4 mm", "2 mm", "1 mm"]


def cases() -> dict[str, Callable[[], Any]]:
    """A scan of each case, by name."""
    file = pindrive.load_device(READER)
    device = file.device
    turned = replace(device, array=replace(device.array, axis=0.15))
    gratings = pindrive.Page(grating=GRATINGS)
    return {
        "three gratings": lambda: pindrive.scan(file, gratings, threads=1),
        "two lines of text": lambda: pindrive.scan(file, "Ab\ncd", threads=1),
        "oblique gratings": lambda: pindrive.scan(turned, gratings, threads=1),
    }


def timed(work: Callable[[], Any], repeats: int) -> float:
    """Median processor time, ms."""
    times = []
    for _ in range(repeats):
        begin = process_time()
        work()
        times.append(1e3 * (process_time() - begin))
    return median(times)


def evaluated(done: Any) -> Any:
    """The evaluation of a scan, also of earlier versions."""
    found = done.evaluate() if hasattr(done, "evaluate") else done.judge()
    return found.counts


def scanned_and_evaluated(scanned: Callable[[], Any]) -> Any:
    """Scan, and evaluate."""
    return evaluated(scanned())


def all_times(repeats: int) -> dict[str, float]:
    """Scan with evaluation of each case, ms."""
    return {
        name: timed(partial(scanned_and_evaluated, scanned), repeats)
        for name, scanned in cases().items()
    }


def built(commit: str, folder: Path) -> Path:
    """The package of a commit, installed into a folder."""
    archive = subprocess.run(
        ["git", "archive", "--format=tar", commit], cwd=ROOT, check=True, capture_output=True
    ).stdout
    with tarfile.open(fileobj=BytesIO(archive)) as tar:
        tar.extractall(folder / "source", filter="data")
    install = ["pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--target"]
    target = folder / "package"
    subprocess.run(
        [sys.executable, "-m", *install, str(target), str(folder / "source")], check=True
    )
    return target


def times_of(package: Path | None, repeats: int) -> dict[str, float]:
    """`all_times` in a process of its own, with the package of a folder."""
    environment = os.environ if package is None else os.environ | {"PYTHONPATH": str(package)}
    command = [sys.executable, str(Path(__file__).resolve()), "--times", str(repeats)]
    result = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(result.stdout)
    return found


def print_stages(repeats: int) -> None:
    """The stages of each case."""
    from pindrive.device.pin_scan import energised

    print(f"{'processor time, ms':22}{'reading':>10}{'motions':>10}{'evaluation':>12}{'all':>10}")
    for name, scanned in cases().items():
        done = scanned()
        reading = timed(partial(energised, done.inputs), repeats)
        motions = timed(scanned, repeats) - reading
        evaluation = timed(partial(evaluated, done), repeats)
        whole = reading + motions + evaluation
        print(f"{name:22}{reading:10.2f}{motions:10.2f}{evaluation:12.2f}{whole:10.2f}")


def print_study(count: int) -> None:
    """Scans a second of the study, with one thread and with two."""
    from pindrive.study.evaluate import evaluate

    study = pindrive.load_study(STUDY)
    columns = {key: x[:count] for key, x in study.columns(0, study.size).items()}
    walls = []
    for threads in (1, 2):
        begin = perf_counter()
        evaluate(study, columns, count, ("lines_shown",), threads)
        walls.append(1e3 * (perf_counter() - begin) / count)
    print(
        f"study: {walls[0]:.2f} ms a scan of one pin with one thread, {walls[1]:.2f} ms with two, "
        f"{walls[0] / walls[1]:.2f} times as fast"
    )


def print_stream() -> None:
    """A millisecond of the reader under a live hand, by `stream.c`."""
    sources = ("scan", "device", "device_parameters", "drive", "stepper")
    with TemporaryDirectory() as folder:
        c, program = Path(folder, "stream.o"), Path(folder, "stream")
        capi, bindings = f"-I{ROOT / 'capi'}", ROOT / "bindings"
        subprocess.run(
            ["cc", "-std=c99", "-O2", capi, "-c", ROOT / "benchmarks" / "stream.c", "-o", c],
            check=True,
        )
        options = ("-std=c++17", "-O3", "-DNDEBUG", "-ffp-contract=off", "-fno-tree-slp-vectorize")
        files = [bindings / "contradictions.cpp"]
        files += [ROOT / "capi" / f"{name}.cpp" for name in sources]
        headers = [f"-I{ROOT / 'include'}", f"-I{bindings}", capi]
        subprocess.run(["c++", *options, *headers, *files, c, "-o", program], check=True)
        print("a millisecond of sixteen pins under a live hand:")
        print(subprocess.run([program], check=True, capture_output=True, text=True).stdout, end="")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--against", metavar="COMMIT", help="commit to compare with")
    parser.add_argument("--times", type=int, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.times:
        print(json.dumps(all_times(arguments.times)))
        return
    print_stages(arguments.repeats)
    print_study(400)
    print_stream()
    if not arguments.against:
        return
    with TemporaryDirectory() as folder:
        package = built(arguments.against, Path(folder))
        runs = [(times_of(package, 3), times_of(None, 3)) for _ in range(3)]
    for name in runs[0][0]:
        before, after = (median(run[k][name] for run in runs) for k in (0, 1))
        print(f"{name:22}{before:10.1f} ms before,{after:8.1f} now: {before / after:5.1f} times")


if __name__ == "__main__":
    main()
