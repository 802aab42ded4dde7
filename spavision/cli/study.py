"""``spavision study``: many model runs under uncertain inputs."""

from __future__ import annotations

import importlib

import click

COMMANDS = {
    "starter": "Print a study file to start from.",
    "sweep": "Run the model over a grid of any parameters.",
    "tolerance": "Band around the modelled path that the suspects' scatter leaves: u_input.",
    "attribute": "How much of the discrepancy each suspect can explain: sensitivities, Sobol indices.",
    "update": "Fit parameters to a measured path, with their posterior; check on other paths.",
    "design": "Crimp ratio and strip for a wished mode-change pressure or tip path.",
}
"""Name and one line of help of each command; the module of the same name in ``studies`` holds it."""


class _LazyStudies(click.Group):
    """A group that imports a study's module only when that study is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"spavision.cli.studies.{cmd_name}")
        command: click.Command = getattr(module, cmd_name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=_LazyStudies, invoke_without_command=True)
@click.pass_context
def study(context: click.Context) -> None:
    """Run the model many times and ask why it differs from the measurement.

    A study file says what is uncertain and by how much. Print one to start from, change it, and run:

    \b
    spavision study starter > study.toml
    spavision study tolerance study.toml --workers 2
    spavision study attribute study.toml --measured track.csv

    Each finished case is kept in the results folder: an interrupted study goes on where it stopped, and
    studies of the same folder share their cases. Cases that fail are listed with the reason.
    """  # noqa: D301
    if context.invoked_subcommand is None:
        click.echo(context.get_help())
