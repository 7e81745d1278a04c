"""The table of quantities, fourth part: the pin of a whole device, where it is not that of a mouse.

One pin of a tactile mouse may be heavy. Sixteen under a finger have magnets a few millimetres wide,
and springs so stiff that none of them reaches the next.
"""

from __future__ import annotations

from typing import Any, Final

READER: Final[dict[str, dict[str, Any]]] = {
    "drive.mass": {
        "default": 0.001,
        "source": "assumed: 0.12 cm3 of iron and copper at 8.4 g/cm3, a cylinder 3.5 mm wide and "
        "12.4 mm high",
    },
    "drive.stiffness": {
        "default": 250.0,
        "source": "assumed: the magnet below carries the pin 1 mm against it, and neighbours 5 mm "
        "apart do not meet; a natural frequency of 80 Hz",
    },
    "drive.damping": {
        "example": 0.5,
        "source": "the damping ratio 0.5 below, with m = 1 g and k = 250 N/m",
    },
    "drive.damping_ratio": {
        "default": 0.5,
        "source": "assumed, an elastic sleeve: half as much again as the largest of 0.04, 0.16, "
        '0.32 in Fig. 4 of "Dynamics of tactile device drive", read as ratios; it settles sooner',
    },
    "plate.kinetic": {
        "default": 0.0022,
        "source": "steel on steel, friction coefficient 0.15-0.30 (handbook tables), 0.225 (the "
        "middle) of a weight of 9.8 mN",
    },
    "plate.static": {
        "default": 0.00265,
        "source": "steel on steel, 0.27 (oxidised, handbook tables) of a weight of 9.8 mN",
    },
    "plate.curve": {
        "source": "steel on steel, 0.225 falling to 0.15 of a weight of 9.8 mN",
        "remark": "for `pindrive simulate` alone: not where a magnet changes the load",
        "rows": ((0.0, 0.0022), (0.05, 0.0015)),
    },
    "finger.kinetic": {
        "default": 0.030,
        "source": "skin, friction coefficient 0.5 (Derler & Gerhardt, review), of 60 mN of touch: "
        "1 N of a finger on sixteen pins, assumed",
    },
    "finger.static": {"default": 0.045},
    "finger.curve": {
        "remark": "speeds from 0 m/s up; kinetic and stiffness are left out then",
        "rows": ((0.0, 0.030), (0.05, 0.024)),
    },
    "finger.stiffness": {
        "default": 300.0,
        "example": None,
        "source": "1000 N/m of the whole finger pad (ROBOMECH J. 2017, 10.1186/s40648-017-0080-8, "
        "Table 1); a pin touches a part of it, assumed: a third",
    },
    "array.spot_scale": {
        "default": 0.5,
        "source": "assumed: sixteen spots on letters 10 mm high; the page is felt twice as large",
    },
    "motion.plate_load": {
        "source": "assumed: a magnet that held the pin with 1 N, 102 times its weight, lets go in "
        "5 ms",
        "rows": ((0.0, 103.0), (0.005, 1.0)),
    },
    "motion.displacement": {
        "default": 0.0009,
        "source": "assumed: the pin was carried nearly as far as its magnet can hold it",
    },
    "motion.skin_stretch": {
        "example": 7.5e-5,
        "source": "assumed: half of what static friction holds, 45 mN / (300 N/m)",
    },
}
"""What differs, by the keys of a device file: fields of a `Quantity`."""
