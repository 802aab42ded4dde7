"""``spavision render``: synthetic photographs with known truth."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from spavision.render.settings import RenderSettings
    from spavision.render.trajectory import Trajectory
    from spavision.results import ResultsFolder


@click.command()
@click.argument("output", type=click.Path(path_type=Path), required=False)
@click.option("--crimp", type=float, help="Sample path and crimp ratio: 0.2, 0.25 or 0.3 [default: 0.3].")
@click.option(
    "--trajectory", type=click.Path(path_type=Path), help="CSV with pressure_kPa, ux_mm, uy_mm instead."
)
@click.option("--scene", type=click.Path(path_type=Path), help="TOML file with settings of the picture.")
@click.option(
    "--set",
    "assignments",
    multiple=True,
    metavar="KEY=VALUE",
    help="One setting, such as optics.defocus_px=2.",
)
@click.option("--seed", type=int, help="Seed of every random number [default: 1].")
@click.option("--list-settings", is_flag=True, help="Print every setting with default, unit and meaning.")
@click.option("--force", is_flag=True, help="Replace the files of an earlier run.")
@click.option("--quiet", "-q", is_flag=True, help="Show no progress.")
def render(
    output: Path | None,
    crimp: float | None,
    trajectory: Path | None,
    scene: Path | None,
    assignments: tuple[str, ...],
    seed: int | None,
    list_settings: bool,
    force: bool,
    quiet: bool,
) -> None:
    """Render photographs of the actuator before its board into the folder OUTPUT.

    Writes the photos, truth.json with what is really in them, and the experiment.toml that a laboratory would
    write beside them. The same settings give the same bytes.
    """
    import dataclasses

    from spavision.errors import InputError
    from spavision.results import ResultsFolder

    from .output import print_lines

    if list_settings:
        _print_settings()
        return
    if output is None:
        raise InputError("OUTPUT is missing; name the folder that the photos go to")
    overrides = assignments if seed is None else (*assignments, f"seed={seed}")
    settings = _settings(scene, overrides, crimp)
    path = _trajectory(trajectory, crimp)
    results = ResultsFolder(output, force=force)
    _write(results, settings, path, quiet=quiet)
    results.record_inputs([given for given in (scene, trajectory) if given is not None])
    results.write_record({"command": "render", "settings": dataclasses.asdict(settings)})
    print_lines([f"Photos: {output}"])


def _settings(scene: Path | None, assignments: tuple[str, ...], crimp: float | None) -> RenderSettings:
    from spavision.render.scene_file import settings_from_table, with_overrides
    from spavision.tables import read_toml

    table = read_toml(scene) if scene is not None else {}
    if crimp is not None:
        assignments = (f"actuator.crimp_ratio={crimp}", *assignments)
    return with_overrides(settings_from_table(table, source=str(scene)), assignments)


def _trajectory(table: Path | None, crimp: float | None) -> Trajectory:
    import numpy as np

    from spavision.errors import InputError
    from spavision.render.trajectory import Trajectory, sample_trajectory
    from spavision.tables import read_tip_path

    if table is None:
        return sample_trajectory(crimp if crimp is not None else 0.3)
    path = read_tip_path(table)
    if not np.all(path.has_reading):
        raise InputError(f"{table}: a displacement is empty; a trajectory needs one at each pressure")
    return Trajectory(path.pressure_kPa, path.ux_mm, path.uy_mm, np.zeros(len(path)))


def _write(results: ResultsFolder, settings: RenderSettings, path: Trajectory, *, quiet: bool) -> None:
    from spavision.render.photo_set import photo_set
    from spavision.workflow.progress import progress_bar

    with progress_bar("photos", total=len(path), quiet=quiet) as advance:
        for number, (name, content) in enumerate(photo_set(settings, path), start=1):
            results.write_bytes(name, content)
            advance(name, min(number, len(path)))


def _print_settings() -> None:
    from spavision.render.scene_file import settings_list

    from .output import print_table

    rows = [list(row) for row in settings_list()]
    print_table("Settings of spavision render", ["setting", "default", "unit", "remark"], rows)
