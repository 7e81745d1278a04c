"""One drive: as data, its motion, the numbers of the motion, many motions at once.

`simulate` and `simulate_batch` are names of `pindrive` itself.

- `Certificate`: the largest violation of each law
- `Coefficients`: friction forces over what presses
- `Contact`: dry friction between the pin and a surface
- `Stribeck`: a contact under Stribeck's law, by which friction falls with the sliding speed
- `HessSoom`: a contact under the law of Hess and Soom
- `ContactUse`: use of one contact in it
- `Afterwards`: use of one contact after it
- `Crossings`: where a quantity of a motion crosses a level
- `Drive`: a mass on a spring and a damper, rubbed by a plate and a fingertip
- `Ending`: how a motion ends, in numbers
- `Event`: a change at a contact
- `Extrema`: extrema of a quantity of a motion
- `Function`: a quantity over time in pieces: polynomials, exponentials, sinusoids
- `harmonic`: a sinusoid about a mean
- `minimum_jerk`: the velocity of a stroke from rest to rest
- `exponential`: an exponential approach of a value
- `InputPiece`: a part of a function from a time on
- `InputTerm`: an exponential or a sinusoid of a piece
- `Ledger`: where the energy came from and where it went
- `Motion`: what a pin does after its release
- `Profile`: a quantity over time, linear between rows
- `Release`: the initial state and the inputs
- `Segment`: a stretch of time in one mode
- `Sensitivity`: derivatives of a motion by its parameters
- `Transient`: the numbers of a transient
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
