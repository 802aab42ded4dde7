"""Reading ``corrections.csv``: what a person says of single photos. It is never written by spavision."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from spavision.errors import InputError
from spavision.tables import numbers, read_columns
from spavision.vision.corrections import Correction

COLUMNS = ("photo", "x_px", "y_px", "reject", "note")

YES, NO = ("yes", "true", "1", "x", "reject"), ("", "no", "false", "0")


def read_corrections(path: Path) -> dict[str, Correction]:
    """Read corrections by photo: the marker's pixel in ``x_px, y_px``, or ``yes`` under ``reject``.

    The word ``reject`` in the place of a pixel's x is understood too. A note is free text.

    Raises
    ------
    InputError
        If the file cannot be read, a column is unknown or missing, or a row does not say one thing.
    """
    columns = read_columns(path)
    unknown = [name for name in columns if name not in COLUMNS]
    if unknown:
        raise InputError(f"{path}: unknown column {unknown[0]}; expected {', '.join(COLUMNS)}")
    if "photo" not in columns:
        raise InputError(f"{path}: column photo is missing; add it, with one photo's file name a row")
    rows = len(columns["photo"])
    texts = {name: columns.get(name, [""] * rows) for name in COLUMNS}
    rejected = [_rejected(texts, row, path) for row in range(rows)]
    # A rejected row's pixel is checked below, and may hold the word itself.
    texts["x_px"] = ["" if text.lower() == "reject" else text for text in texts["x_px"]]
    x_px, y_px = (numbers(texts, name, path, allow_empty=True) for name in ("x_px", "y_px"))
    corrections: dict[str, Correction] = {}
    for row, photo in enumerate(texts["photo"]):
        where = f"{path}: row {row + 2} ({photo or 'no photo'})"
        if not photo or photo in corrections:
            raise InputError(
                f"{where} {'repeats a photo' if photo else 'names no photo'}; keep one row a photo"
            )
        given = np.isfinite([x_px[row], y_px[row]])
        if rejected[row] == given.any() or given.any() != given.all():
            raise InputError(f"{where}: expected either x_px and y_px, or yes under reject; mend that row")
        pixel = (float(x_px[row]), float(y_px[row])) if given.all() else None
        corrections[photo] = Correction(pixel, texts["note"][row])
    return corrections


def _rejected(texts: dict[str, list[str]], row: int, path: Path) -> bool:
    word = texts["reject"][row].lower()
    if word not in YES + NO:
        raise InputError(f"{path}: reject in row {row + 2} is {word!r}; expected yes, or nothing")
    return word in YES or texts["x_px"][row].lower() == "reject"
