"""Optimisation: wishes in, designs out.

- `Alternative`: another part of a catalogue in place of the chosen one
- `Demanded`: a demand, and how a design meets it
- `Design`: what `optimise` found
- `Effort`: how much is tried
- `Front`: designs of which none is better than another in all goals
- `Goal`: a number that is to be small, or large
- `Map`: a goal over two variables, and where all demands are met
- `optimise`: finds the design that meets a wish best
- `Reached`: a goal, and how far a design reaches it
- `read_wish`: the wish that a file describes
- `Wish`: a device, what may vary, under which conditions, what is demanded, and the goals
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
