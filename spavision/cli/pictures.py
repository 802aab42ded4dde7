"""Encoding pictures and figures, the same bytes for the same content."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

JPEG_QUALITY = 88
"""The thin lines of an overlay stay sharp."""

FIGURE_DPI = 160


def jpeg(image: NDArray[np.uint8], *, longest_side_px: int | None = None) -> bytes:
    """Encode an RGB picture, shape (height, width, 3), as JPEG, scaled down where it is larger than asked."""
    from PIL import Image

    picture = Image.fromarray(image)
    if longest_side_px is not None:
        picture.thumbnail((longest_side_px, longest_side_px))
    buffer = io.BytesIO()
    picture.save(buffer, format="JPEG", quality=JPEG_QUALITY)
    return buffer.getvalue()


def figure_bytes(figure: Figure, ending: str) -> bytes:
    """Encode a figure as ``png`` or ``svg`` without the date and random names that matplotlib adds."""
    import matplotlib as mpl

    metadata: dict[str, Any] = {"Date": None} if ending == "svg" else {}
    buffer = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "spavision", "svg.fonttype": "none"}):
        figure.savefig(buffer, format=ending, dpi=FIGURE_DPI, metadata=metadata)
    return buffer.getvalue()
