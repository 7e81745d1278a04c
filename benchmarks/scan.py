"""Time of a scan: sixteen pins over ten seconds of hand motion along two lines of text.

What is timed is the simulation: reading the scene under each spot, switching the coils, and each
pin's whole motion. Making the page and measuring what the pins did are timed apart. `--angle 10`
turns the drive in the housing, so that the hand moves across it too.
"""

from __future__ import annotations

import argparse
import os
import platform
from dataclasses import replace
from math import radians
from statistics import median
from time import perf_counter, process_time

from pindrive import Contact, Drive
from pindrive.device import Device, Electromagnet, PinArray, scan
from pindrive.device.reading import Reading
from pindrive.device.scanning import ScanInputs, energised

TEXT = "A quick brown\nfox jumps ov"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--threads", type=int, default=None)
    parser.add_argument("--angle", type=float, default=0.0, help="of the drive, degrees")
    arguments = parser.parse_args()

    drive = Drive(
        mass=0.010,
        stiffness=100.0,
        damping_ratio=0.16,
        plate=Contact(0.022, 0.0265),
        finger=Contact(0.005, 0.0075),
    )
    magnet = Electromagnet(hold_force=3.0)
    array = replace(PinArray.grid(4, 4, 0.0025), axis=radians(arguments.angle))
    device = Device(drive=drive, magnet=magnet, array=array)
    reading = Reading()
    begin = perf_counter()
    scene = reading.text(TEXT, device.array)
    path = reading.strokes(scene, device.array)
    page = perf_counter() - begin

    walls, cores, switching = [], [], []
    for _ in range(arguments.repeats):
        begin, work = perf_counter(), process_time()
        done = scan(device, scene, path, threads=arguments.threads)
        walls.append(perf_counter() - begin)
        cores.append(process_time() - work)
        begin = perf_counter()
        energised(ScanInputs(device, scene, path, None, None))
        switching.append(perf_counter() - begin)
    begin = perf_counter()
    done.to_dataset()
    numbers = perf_counter() - begin

    print(f"{platform.system()}, {os.cpu_count()} processors, Python {platform.python_version()}")
    pins = done.pins
    print(
        f"{len(pins)} pins, {path.end - path.begin:.2f} s of hand motion: "
        f"{sum(len(p.commands.times) for p in pins)} switchings, "
        f"{sum(len(p.events) for p in pins)} events, "
        f"{sum(len(p.motion.segments) for p in pins)} segments"
    )
    for words, times in (
        ("simulation", walls),
        ("  of processor time", cores),
        ("  of which reading and switching", switching),
    ):
        print(f"{words:34} {1e3 * median(times):7.1f} ms, best {1e3 * min(times):.1f} ms")
    print(f"{'the page and the path':34} {1e3 * page:7.1f} ms")
    print(f"{'columns, events and numbers':34} {1e3 * numbers:7.1f} ms")


if __name__ == "__main__":
    main()
