"""How the ray caster's inner functions are compiled."""

from __future__ import annotations

from typing import Any

from numba import njit

_WITHOUT_WRAPPERS: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}

kernel = njit(cache=True, error_model="numpy", **_WITHOUT_WRAPPERS)
"""For functions that compiled code alone calls: without wrappers for Python they compile faster."""
