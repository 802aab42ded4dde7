"""The sample photographs that come with the project."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

from spavision.errors import InputError

FOLDER_NAME = re.compile(r"crimp-(\d\.\d+)$")


def nearest_sample_set(crimp_ratio: float) -> tuple[Path, float]:
    """Return the sample set nearest to a crimp ratio, and that set's own ratio.

    Raises
    ------
    InputError
        If the installation holds no sample set.
    """
    root = Path(str(resources.files("spavision.sample_images")))
    sets = {
        float(match[1]): path
        for path in sorted(root.iterdir())
        if path.is_dir() and (match := FOLDER_NAME.match(path.name))
    }
    if not sets:
        raise InputError("no sample photos are installed; name your own with --photos DIR or --measured CSV")
    nearest = min(sets, key=lambda ratio: (abs(ratio - crimp_ratio), ratio))
    return sets[nearest], nearest
