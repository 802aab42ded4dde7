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


def jpeg(image: NDArray[np.uint8]) -> bytes:
    """Encode an RGB picture, shape (height, width, 3), as JPEG."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, format="JPEG", quality=JPEG_QUALITY)
    return buffer.getvalue()


def figure_bytes(figure: Figure, ending: str, *, dpi: int = FIGURE_DPI) -> bytes:
    """Encode a figure as ``png``, ``jpg`` or ``svg`` without the date and names that matplotlib adds."""
    import matplotlib as mpl

    metadata: dict[str, Any] | None = {"Date": None} if ending == "svg" else None
    buffer = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "spavision", "svg.fonttype": "none"}):
        figure.savefig(buffer, format=ending, dpi=dpi, metadata=metadata)
    return buffer.getvalue()
