"""Track three of the sample photographs."""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from spavision import track
from spavision.samples import nearest_sample_set

samples, crimp_ratio = nearest_sample_set(0.3)

# A folder of one's own: three photographs and what is known of the set-up.
with TemporaryDirectory() as folder:
    for name in ("IMG_0000_000kPa.jpg", "IMG_0004_020kPa.jpg", "IMG_0008_040kPa.jpg", "experiment.toml"):
        shutil.copy(samples / name, folder)
    tracked = track(folder)

    print(tracked.table())
    for source in tracked.measurement.track.budget:
        print(
            f"{source.name:24s} {source.sigma_ux_mm[-1]:.4f} mm at {tracked.tip_path.pressure_kPa[-1]:g} kPa"
        )
    tracked.plot().savefig("tip_path.png")
    tracked.save("results/tracked")

# The article: at crimp ratio 0.3 the tip moves 71.25 mm sideways up to 40 kPa.
print(Path("results/tracked/track.csv").read_text())
