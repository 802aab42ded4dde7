"""Build the wheel, install it in an environment of its own, and check what it claims and that it starts."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ALLOWED_TOP_LEVEL = {"spavision"}

USE = """
import spavision.correlate.report, spavision.model.fitting, spavision.model.simulate, spavision.vision.track
from spavision.samples import nearest_sample_set
from spavision.model.materials.library import find_material
find_material("Mold Star 15")
assert nearest_sample_set(0.2)[1] == 0.2
"""


def main() -> None:
    """Run the check; exit non-zero with a sentence when it fails."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(sys.executable, "-m", "build", "--wheel", "--outdir", folder, ROOT)
        wheel = next(folder.glob("*.whl"))
        refuse_foreign_names(wheel)
        run(sys.executable, "-m", "venv", folder / "venv")
        python = folder / "venv" / "bin" / "python"
        run(python, "-m", "pip", "install", "--quiet", "--constraint", ROOT / "constraints.txt", wheel)
        run(folder / "venv" / "bin" / "spavision", "--version", cwd=folder)
        run(python, "-c", USE, cwd=folder)
    print(f"wheel check passed: {wheel.name}")


def refuse_foreign_names(wheel: Path) -> None:
    """Exit when the wheel claims a top-level name other than the project's."""
    with zipfile.ZipFile(wheel) as archive:
        top_level = {entry.split("/")[0] for entry in archive.namelist()}
    foreign = {entry for entry in top_level if not entry.endswith(".dist-info")} - ALLOWED_TOP_LEVEL
    if foreign:
        sys.exit(f"{wheel.name} claims the top-level names {sorted(foreign)}, allowed is spavision alone")


def run(*command: object, cwd: Path | None = None) -> None:
    """Run one command and stop when it fails."""
    subprocess.run([str(part) for part in command], check=True, cwd=cwd)


if __name__ == "__main__":
    main()
