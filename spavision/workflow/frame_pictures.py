"""The report's pairs of pictures, photo and model at one pressure, in one frame and scale."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from .pictures import figure_bytes

if TYPE_CHECKING:
    from spavision.correlate.frames import Window
    from spavision.correlate.report import Picture
    from spavision.model.simulation import Simulation
    from spavision.vision.arrays import RgbImage
    from spavision.vision.track import Track

PIXELS_A_MM = 4.0
"""Scale that photos are straightened with: as fine as the report shows them."""

PAGE_DPI = 110
"""Readable on a page of two pictures, and the page stays small enough to send."""


@dataclass
class PhotoPictures:
    """Straightened overlays, collected while they are drawn."""

    track: Track
    window: Window
    by_pressure_kPa: dict[float, Picture] = field(default_factory=dict)

    def show(self, row: int, overlay: RgbImage) -> None:
        """Keep the picture of one photo."""
        from spavision.correlate.frames import photo_figure
        from spavision.correlate.report import Picture
        from spavision.vision.straightened import straightened

        reading = self.track.readings[row]
        flat = straightened(
            overlay,
            self.track,
            row,
            x_range_mm=self.window.x_mm,
            y_range_mm=self.window.y_mm,
            pixels_a_mm=PIXELS_A_MM,
        )
        if flat is None:
            return
        figure = photo_figure(flat, self.window, title=f"{reading.photo}, {reading.pressure_kPa:g} kPa")
        self.by_pressure_kPa[reading.pressure_kPa] = Picture(
            figure_bytes(figure, "jpg", dpi=PAGE_DPI),
            "image/jpeg",
            f"{reading.photo} with what was measured, straightened to the marker's plane",
        )


def model_pictures(simulation: Simulation, window: Window) -> dict[float, Picture]:
    """Draw the deformed actuator at each pressure reached."""
    from spavision.correlate.frames import model_figure
    from spavision.correlate.report import Picture
    from spavision.model.figures import stretch_range

    path, norm = simulation.tip_path, stretch_range(simulation)
    return {
        float(path.pressure_kPa[row]): Picture(
            figure_bytes(model_figure(simulation, int(row), window, norm), "png", dpi=PAGE_DPI),
            "image/png",
            f"The model at {path.pressure_kPa[row]:g} kPa, to the same scale",
        )
        for row in np.flatnonzero(path.has_reading)
    }
