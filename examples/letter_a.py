"""The letter A, read at three hand speeds: what a column of eight pins shows of it.

The pins stand 5 mm apart along a finger, their spots on the letter a quarter of that.

python examples/letter_a.py [PICTURE]
"""

import sys
from pathlib import Path

import pindrive as pd
from pindrive.plot.scan import plot_reliefs
from pindrive.plot.style import save

SPEEDS = (30, 60, 120)  # mm/s
DEVICE = Path(__file__).with_name("tactile-reader.toml")
COLUMN = ["array.columns=1", "array.rows=8", "array.spot_scale=0.25"]

evaluations = []
for speed in SPEEDS:
    device = pd.load_device(DEVICE, [*COLUMN, f"hand_speed={speed} mm/s"])
    evaluations.append(pd.scan(device, "A").evaluate())

picture = sys.argv[1] if len(sys.argv) > 1 else "letter-a.png"
save(plot_reliefs(evaluations), picture)
print(f"Wrote {picture}")
