"""Several bodies on one axis: springs, dampers and dry friction between them.

`System` is a name of `pindrive` itself.

- `System`: bodies, springs and contacts, to be simulated
- `Body`: a body of a system
- `Spring`: a spring with a damper beside it
- `ContactPair`: dry friction between two bodies
- `SystemMotion`: the motion of a system
- `BodyMotion`: the motion of one body
- `ContactMotion`: a contact under way
- `SpringMotion`: a spring under way
- `Stop`: stops of the distance between two bodies
- `StopMotion`: a stop under way
- `Feedback`: a controller between two bodies
- `FeedbackMotion`: a controller under way
- `SystemEvent`: a change at a contact
- `SystemEnding`: how a motion ends
- `SystemLedger`: energy over a motion
- `SystemCertificate`: the largest violation of each law
- `SystemSensitivity`: derivatives of a motion by its parameters
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
