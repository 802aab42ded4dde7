"""Track a soft pneumatic actuator, simulate it with finite elements, and compare the two."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .front import compare, simulate, track

__all__ = ["compare", "simulate", "track"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    # The command line asks for the version alone and must not wait for what computes.
    if name in __all__:
        from . import front

        return getattr(front, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
