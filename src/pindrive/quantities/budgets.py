"""Limits on the counts of a run, checked before any allocation.

A device file of a few lines can ask for any amount of work. The requested work is counted first.
The limits keep a run on one machine below 4 GB of memory and, with as many cores as a laptop has,
in the order of a minute; each says what it is that takes the memory or the time.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Final

from pindrive.quantities.refusal import check_whole, refusal


@dataclass(frozen=True, slots=True)
class Budget:
    """The largest count of one thing."""

    counted: str
    """Name of the counted things, as in a message."""
    most: int
    why: str
    """Cost of a counted thing."""

    def check(self, count: float, of: str = "", *, where: str = "") -> None:
        """Refuse a count beyond the limit.

        Args:
            count: Requested number; a value that is not a number is too many.
            of: Origin of the number, for messages: "16 pins over 10 s".
            where: The place that asks for them, said first.

        Raises:
            ValueError: The count exceeds the budget.
        """
        if not count <= self.most:
            given = f"{count:.0f}" if count < 1e15 else f"{count:.3g}"
            shown = f"{given} ({of})" if of else given
            raise ValueError(refusal(self.counted, f"at most {self.most}", shown, where))


SAMPLES_OF_CONTROL: Final = Budget(
    "the samples of the control block",
    20_000_000,
    "a time and a luminance of 8 bytes each are kept for every pin",
)
STROKES: Final = Budget("the strokes of the hand", 20_000, "each is some hundred rows of its speed")
SWITCHINGS: Final = Budget(
    "the switchings of the coils of all pins",
    100_000,
    "each begins a new course of the pull, of a hundred rows",
)
INPUT_ROWS: Final = Budget(
    "the rows of hand speed and pull, over all pins,",
    1_500_000,
    "each begins a segment of 256 bytes in the core, and is some 400 bytes more in Python",
)
SEGMENTS: Final = Budget(
    "the segments of the motions of all pins",
    3_000_000,
    "as INPUT_ROWS; what friction adds is known only as the run goes",
)
MOMENTS: Final = Budget(
    "the moments found in a motion",
    20_000_000,
    "a time and a value of 8 bytes each; 0.3 µs each in the core",
)
TURNS: Final = Budget(
    "the turning points of the pins",
    1_500_000,
    "2 in each period of the fastest vibration; 16 bytes and some µs each to evaluate",
)
SAMPLES_OF_PAGE: Final = Budget(
    "the samples of lines on the page",
    20_000_000,
    "4 in each pixel of every pin's way, 0.3 µs each; nothing of them is kept",
)
LINES: Final = Budget(
    "the lines that pass under all pins", 100_000, "to evaluate one takes a millisecond"
)
PIXELS: Final = Budget(
    "the pixels of the page",
    40_000_000,
    "8 bytes each, three times while it is made; A4 at 600 dots per inch has 35 million",
)
CHARACTERS: Final = Budget(
    "the characters of the text", 100_000, "each is set by itself; a page has 3000"
)
PAINTED: Final = Budget(
    "the places painted by all pins", 300_000_000, "0.1 µs each; nothing of them is kept"
)
SAMPLES: Final = Budget(
    "the samples of all pins",
    5_000_000,
    "eleven numbers of 8 bytes each, three times while the file is made",
)
MOTION_SAMPLES: Final = Budget(
    "the samples of the motion", 10_000_000, "100 bytes each, and 4 µs to write them as text"
)
MOTION_PHASES: Final = Budget(
    "the phases of a motion that is written as JSON", 300_000, "4 kB each while it is made"
)
FRAMES: Final = Budget(
    "the frames of the film", 5000, "each is drawn in 0.05 s; a film may be less slowed"
)
PITCHES: Final = Budget("the pitches", 50, "half a second each: a hundred scans of four pins")
AXIS_VALUES: Final = Budget(
    "the values of a key that counts pins", 10_000, "each is checked to be whole"
)
CHUNK: Final = Budget(
    "the points of a chunk", 1 << 19, "of each 45 numbers of 8 bytes, for every thread at once"
)
CHUNK_OF_SCANS: Final = Budget(
    "the points of a chunk of scans", 1 << 12, "of each 4 kB, and some tenths of a second"
)
CHUNKS: Final = Budget(
    "the chunks of the study",
    1_000_000,
    "each is 250 bytes of memory and a line of the journal; how many points they hold is for the "
    "disk to say, which is asked before the file is made",
)
AXIS: Final = Budget(
    "the values of an axis", CHUNK.most * CHUNKS.most, "no study could have more points"
)
CONSTRAINTS: Final = Budget(
    "the limits of the specification", 50, "for each the worst case is searched for"
)
DESIGN_VALUES: Final = Budget(
    "the numbers of the design",
    100_000_000,
    "8 bytes each: the keys and results of every point, and the sums of the estimators",
)


def usable_cores() -> int:
    """Return the number of processor cores available to this process."""
    of_this_process = getattr(os, "sched_getaffinity", None)
    return len(of_this_process(0)) if of_this_process else os.cpu_count() or 1


MOST_THREADS: Final = 4096
"""More than any machine has cores; each takes memory of its own."""


def worker_count(threads: int | None) -> int:
    """Return the given number of workers, or the number of available cores.

    Raises:
        ValueError: The value is no count.
    """
    return usable_cores() if threads is None else check_whole(threads, "threads", most=MOST_THREADS)
