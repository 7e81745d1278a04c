"""Evaluation of scans against the printed page: by lines, by pitch, as an image.

- `FalseLine`: a swing of a pin that feels like a line and is none
- `Edge`: one end of a printed line, and what became of it
- `evaluate`: what the finger was shown, line by line
- `Evaluation`: what the finger was shown in a scan
- `largest_speeds`: the largest hand speed at which two lines stay distinct
- `largest_hand_speeds`: the same where the pins slow the hand
- `Line`: one printed line under one pin
- `PageSpeeds`: what becomes of the lines of a page at each hand speed
- `SpeedLimit`: how fast a hand may go over two lines
- `SpeedLimits`: the same of each of several pitches
- `speeds_over_page`: the hand speeds at which a page can be read
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
