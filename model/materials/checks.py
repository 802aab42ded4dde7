"""What every law's parameters must satisfy."""

from __future__ import annotations

import math


def require_positive(law: str, **values: float) -> None:
    """Refuse parameters that are not positive, finite numbers.

    Raises
    ------
    ValueError
        Naming the law and the first parameter that is not.
    """
    for name, value in values.items():
        if not (value > 0.0 and math.isfinite(value)):
            raise ValueError(f"{law}: {name} is {value:g}, expected a positive number")
