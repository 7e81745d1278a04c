"""Studies: many releases or scans of one device, each with other values of its keys.

A study file, or Python, names a device and says which of its keys change and how. `Study.run` and
`sweep` compute every point; sensitivities and yields follow from the same study.

- `Bifurcation`: what `bifurcation` found
- `Elasticities`: by how many per cent each number changes when a key grows by one per cent
- `SobolIndices`: which key matters to which number, by Sobol' indices
- `load_study`: a study from its file
- `Robustness`: what `robustness` found
- `Study`: a device, and what is varied of it
- `SystemStudy`: a system of several bodies, and what is varied of it
- `Sweep`: what `sweep` computed, and the file that holds it
- `sweep`: computes every point of a study into a file
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
