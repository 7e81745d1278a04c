"""The sentences before the analysis: what the paper sets out, listed and not judged."""

from __future__ import annotations

from typing import Final

from pindrive.paper.population import Claim

_SENTENCES: Final = (
    (
        "Introduction",
        "The method, where information transmitting pin stimulates operator fingertip skin moving "
        "tangentially to it and the patented tactile device were proposed",
        "figure-1-device",
        "Describes the device.",
    ),
    (
        "Introduction",
        "When the cursor is in the information area (black lines, letters) the control block sends "
        "signals and electromagnet of the drive is magnetized to the metallic surface.",
        "figure-1-device",
        "Describes how it works. `pindrive.Device` has scene, control block and coil; here the "
        "pull is a factor on the plate's friction.",
    ),
    (
        "Introduction",
        "The pin slides along the fingertip and produces the strains in the skin at the contact "
        "area and thus transmits the information.",
        "figure-2-velocity",
        "Describes how it works. A finger with a tangential stiffness, which the paper's equation "
        "leaves out, has a skin that stretches.",
    ),
    (
        "Experiment",
        "The interaction between finger skin and pin is there the key process because during it "
        "the information is transmitted to user.",
        "",
        "Says what matters to its authors.",
    ),
    (
        "Experiment",
        "The experiments have shown that the tactile device is functioning properly when the "
        "surface on which it is laid is clean and dry and the directions of the drive and movement "
        "of the device are kept parallel enough.",
        "",
        "A condition of operation, from measurements that are not printed. This report keeps it: "
        "one friction coefficient at the plate, and a hand that moves along the drive. "
        "`pindrive.Device` follows an oblique hand: at 10° the pin of examples/tactile-reader.toml "
        "goes 84 % as far as under an aligned hand, at 30° 69 %, at 60° 26 %, and from 84° on it "
        "shows no line (docs/studies.md).",
    ),
    (
        "Experiment",
        "During the investigation a significant parameters of the transitional process were framed "
        "– the time of the transitional period and the maximum displacement of the transitional "
        "process.",
        "influence-on-time",
        "Says what is asked; both are computed for every parameter.",
    ),
    (
        "Experiment",
        "The relationship of transitional process parameters and dynamic parameters of the pin "
        "drive and working regime (surface friction, damping, rigidity, system load, speed of the "
        "mouse, initial deflection of pin,) was settled as a problem for the following "
        "investigation.",
        "influence-on-displacement",
        "Says what is asked. System load is taken for the touch force, rigidity for the stiffness.",
    ),
)


def statements() -> list[Claim]:
    """The sentences of introduction and experiment."""
    return [
        Claim(place, sentence, None, shown_by, finding)
        for place, sentence, shown_by, finding in _SENTENCES
    ]
