"""pindrive: exact simulation of a tactile device's pin drive under dry friction."""

import lazy_loader

_public_name, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> object:
    """Import a public name at its first use; `import pindrive` itself loads no other module."""
    if name == "__version__":
        from importlib.metadata import version

        globals()[name] = version(__name__)  # reading it takes milliseconds
        return globals()[name]
    return _public_name(name)
