"""The ramp as an animated GIF."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from matplotlib.colors import Normalize
from PIL import Image

from .figures import deformed_state, stretch_range
from .simulation import Simulation

_FRAME_MS = 300
_LAST_FRAME_MS = 1500
_DPI = 90


def write_ramp_gif(simulation: Simulation, path: Path) -> None:
    """Draw the deformed side face at each pressure reached, one after another, to one scale.

    Parameters
    ----------
    simulation : Simulation
    path : Path
        Ending in ``.gif``.

    Raises
    ------
    ValueError
        If no pressure was reached.
    """
    reached = np.flatnonzero(simulation.tip_path.has_reading)
    if len(reached) == 0:
        raise ValueError("no pressure was reached, so there is nothing to animate")
    norm = stretch_range(simulation)
    frames = [_frame(simulation, int(row), norm) for row in reached]
    durations = [_FRAME_MS] * (len(frames) - 1) + [_LAST_FRAME_MS]
    frames[0].save(
        path, format="GIF", save_all=True, append_images=frames[1:], duration=durations, loop=0, disposal=2
    )


def _frame(simulation: Simulation, row: int, norm: Normalize) -> Image.Image:
    buffer = io.BytesIO()
    deformed_state(simulation, row, norm).savefig(buffer, format="png", dpi=_DPI)
    # A fixed palette for all frames would band the colours: each has its own.
    return Image.open(buffer).convert("RGB").quantize(colors=128, dither=Image.Dither.NONE)
