"""pindrive: exact simulation of a tactile device's pin drive under dry friction."""


def __getattr__(name: str) -> object:
    """Import a public name at its first use; `import pindrive` itself loads no other module."""
    from pindrive.lazy import attach

    get, _ = attach(__name__)
    return get(name)


def __dir__() -> list[str]:
    """The public names alone."""
    return sorted(__getattr__("__all__"))  # type: ignore[call-overload]
