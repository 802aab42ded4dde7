"""Whether a study is of the actuator, model and path that a comparison is of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from spavision.tip_path import TipPath

SETTINGS_OF_THE_SOLUTION = ("mesh", "control")
"""Keys of the model that change how well it is solved: of no account to how much its results scatter."""

_SAME_DISPLACEMENT_MM = 0.01


def first_difference(theirs: Mapping[str, Any], ours: Mapping[str, Any]) -> str | None:
    """Say in which key two descriptions of a model differ; None where they agree.

    Parameters
    ----------
    theirs, ours : mapping
        Of the study and of the comparison, as `model_description` returns them.
    """
    differing = [
        (section, key)
        for section, keys in ours.items()
        for key, value in keys.items()
        if key not in SETTINGS_OF_THE_SOLUTION and theirs.get(section, {}).get(key) != value
    ]
    if not differing:
        return None
    section, key = differing[0]
    rest = len(differing) - 1
    more = f" ({rest} more key{'s differ' if rest > 1 else ' differs'})" if rest else ""
    if section == "materials":
        return f"the law behind {key} is another now{more}"
    if section == "curve":
        return f"the composite's curve has other data now{more}"
    left, right = theirs.get(section, {}).get(key), ours[section][key]
    return f"its [{section}] {key} is {left!r}, the comparison's {right!r}{more}"


def same_path(theirs: Mapping[str, Any], ours: TipPath) -> bool:
    """Whether a path that was kept as lists is the given one, reading by reading."""
    readings = ours.readings()
    columns = [readings.pressure_kPa, readings.ux_mm, readings.uy_mm]
    kept = [np.array(theirs.get(name, ()), dtype=float) for name in ("pressure_kPa", "ux_mm", "uy_mm")]
    return all(
        len(one) == len(other) and bool(np.all(np.abs(one - other) < _SAME_DISPLACEMENT_MM))
        for one, other in zip(kept, columns, strict=True)
    )
