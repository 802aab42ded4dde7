"""What a person says of the marker in single photographs: its pixel, or that the reading is no good."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from spavision.errors import InputError

from .observe import Observation


@dataclass(frozen=True)
class Correction:
    """A person's word on one photograph.

    Parameters
    ----------
    pixel : tuple of float, or None
        Centre of the marker in the upright photograph, px, used as it is; None where the reading is rejected.
    note : str
        Why.
    """

    pixel: tuple[float, float] | None
    note: str = ""

    @property
    def remark(self) -> str:
        """What the reading's reason says of it."""
        if self.pixel is None:
            return self.note or "rejected by hand"
        return f"marker given by hand: {self.note}" if self.note else "marker given by hand"


Corrections = Mapping[str, Correction]
"""File name of a photograph to its correction."""


def refuse_unknown_photos(corrections: Corrections, names: Iterable[str]) -> None:
    """Refuse corrections of photographs that are not there.

    Raises
    ------
    InputError
        Naming the first of them.
    """
    unknown = sorted(set(corrections) - set(names))
    if unknown:
        raise InputError(
            f"the corrections name {unknown[0]}, which is not among the photographs; correct the file name"
        )


def refuse_outside_pixels(corrections: Corrections, observations: Iterable[Observation]) -> None:
    """Refuse corrections whose pixel lies outside its photograph.

    Raises
    ------
    InputError
        Naming the first of them.
    """
    for o in observations:
        pixel = corrections[o.name].pixel if o.name in corrections else None
        if pixel is None or o.width == 0:
            continue
        x, y = pixel
        if not (-0.5 <= x <= o.width - 0.5 and -0.5 <= y <= o.height - 0.5):
            raise InputError(
                f"the corrections place the marker of {o.name} at ({x:g}, {y:g}) px, outside the photo of "
                f"{o.width}×{o.height} px; give its pixel in the upright photo"
            )


def without_corrected_spots(corrections: Corrections, observations: list[Observation]) -> list[Observation]:
    """Take the spots out of corrected photographs: there a person has decided what is the marker."""
    return [replace(o, candidates=()) if o.name in corrections else o for o in observations]
