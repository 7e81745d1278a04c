"""The whole device: a hand moves over a page, a control block reads it, pins move a finger.

- `Coil`: an electromagnet by how it is made
- `CoilState`: the last switching of a coil
- `Commands`: on and off of one coil over time
- `ControlBlock`: a threshold with hysteresis, at a sample rate, with latency
- `Criteria`: what counts as felt
- `Current`: the current in a coil over time
- `DataSheet`: an electromagnet by its data sheet
- `Decision`: where the control block stands for one coil
- `Device`: drive, magnet, control block and pin array
- `Electromagnet`: what an electromagnet does to the plate
- `Gap`: how close two neighbouring pins come
- `Hand`: a hand that gives way to its pins
- `HandMotion`: the path that such a hand takes, beside the intended one
- `HandPath`: where the hand is over time
- `lines`: a path line by line over a page
- `Page`: what is on a page, and how the hand moves over it
- `PinArray`: where the pins stand, and the spot that each shows
- `PinScan`: one pin in a scan
- `PinState`: where a pin and its magnet stand at one time
- `read_csv`: a recorded path from a CSV
- `Reading`: how a hand reads
- `HandRecording`: places of the hand at recorded times
- `Scan`: what a device did while a hand moved it
- `scan`: move a device over a page, and follow each of its pins
- `Scene`: the luminance of a page
- `strokes`: a path of straight strokes of minimum jerk
- `through`: a path along recorded places
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
