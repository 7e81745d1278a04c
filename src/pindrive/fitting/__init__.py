"""Fitting: recordings of a pin in, parameters of its drive with their uncertainty out.

- `compare_models`: fits of other laws of friction to the recordings of a fit, by AICc
- `Estimate`: one fitted parameter
- `fit`: fits parameters of a drive and its releases to recordings
- `Fit`: what `fit` found
- `FitProblem`: a fit as its file describes it
- `fit_friction`: fits a friction curve to friction forces that were measured at sliding speeds
- `FrictionCurve`: a friction curve that was fitted
- `FittedLaw`: a friction law that was fitted
- `Identifiability`: whether recordings tell a parameter
- `load_fit`: a fit from its file
- `ModelComparison`: fits of several laws of friction to the same recordings
- `Noise`: noise of a recorded channel: size, drift, hum, correlation, outliers, steps, averages
- `read_recording`: a recording from a CSV file whose header names columns with their units
- `Recording`: samples of one release, and what is known of it
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
