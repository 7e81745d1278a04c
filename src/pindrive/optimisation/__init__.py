"""Optimisation: design problems in, designs out.

- `Alternative`: another part of a catalogue in place of the chosen one
- `ConstraintResult`: a constraint, and how a design meets it
- `Design`: what `optimise` found
- `Effort`: how much is tried
- `Front`: designs of which none is better than another in all goals
- `Goal`: a number that is to be small, or large
- `Map`: a goal over two variables, and where all constraints are met
- `optimise`: finds the design that meets a design problem best
- `Reached`: a goal, and how far a design reaches it
- `read_problem`: the design problem that a file describes
- `DesignProblem`: a device, what may vary, under which conditions, what is required, and the goals
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
