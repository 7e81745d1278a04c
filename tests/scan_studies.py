"""Small studies of scans for the tests, in the folder that they are in."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from pindrive.study.runner import on_threads, sweep
from pindrive.study.spec import load_study
from pindrive.study.study import Study

DEVICE = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping_ratio = 0.32
[plate]
kinetic = "22 mN"
[finger]
kinetic = "20 mN"
stiffness = "300 N/m"
[array]
pitch = "3 mm"
[scan]
hand_speed = "100 mm/s"
pause = "50 ms"
"""
COILED = """
[magnet]
turns = 300
pole_area = "6 mm^2"
gap = "0.06 mm"
wire_diameter = "0.1 mm"
turn_length = "16 mm"
supply_voltage = "3 V"
"""
GRATING = '[page]\ngrating = ["4 mm"]\n'


def study(text: str, page: str = GRATING, device: str = DEVICE, name: str = "study.toml") -> Study:
    Path(name).write_text(text + "\n" + page + device)
    return load_study(name)


def swept(plan: Study, target: str = "study.nc") -> xr.Dataset:
    sweep(plan, Path(target), work=on_threads(1))
    with xr.open_dataset(target) as data:
        return data.load()
