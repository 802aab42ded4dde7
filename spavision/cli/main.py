"""The entry point: finds the command asked for, loads it alone, and turns bad input into one sentence."""

from __future__ import annotations

import importlib
import sys
import traceback
import warnings
from typing import NoReturn, TextIO

import click

from spavision import __version__
from spavision.errors import InputError, InputWarning

COMMANDS = {
    "track": "Measure the tip in photographs: photos -> tip path with uncertainty.",
    "calibrate": "Calibrate a camera: photos of a whole board -> camera.toml, coverage map.",
    "simulate": "Run the 3D finite-element model: pressures -> tip path, fields.",
    "correlate": "Compare the measured with the modelled tip path at the same pressures.",
    "study": "Sweeps, tolerances, attribution, model updating, design: many model runs.",
    "fit": "Fit hyperelastic laws to test data, with uncertainty and stability.",
    "coupon": "Pull a virtual coupon of matrix and crimped paper, of any crimp ratio.",
    "materials": "List the materials of the library and of a folder of yours.",
    "render": "Render synthetic photographs with known truth.",
}
"""Name and one line of help of each command; the module of the same name holds it."""


class _LazyGroup(click.Group):
    """A group that imports a command's module only when that command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = getattr(importlib.import_module(f"spavision.cli.{cmd_name}"), cmd_name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=_LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="spavision")
@click.option("--debug", is_flag=True, help="Show the traceback of an internal error.")
def main(debug: bool) -> None:
    """Track a soft pneumatic actuator in photographs, simulate it, and compare the two.

    \b
    spavision track photos/            photos -> tip displacement with uncertainty
    spavision correlate --crimp 0.2    measured against model at the same pressures
    """  # noqa: D301


def run() -> NoReturn:
    """Run the command line.

    It exits with 2 on bad input, 3 where ``--strict`` is not met, 1 on an internal error, and 130 when
    interrupted.
    """
    debug = "--debug" in sys.argv
    arguments = [argument for argument in sys.argv[1:] if argument != "--debug"]
    warnings.showwarning = _show_warning
    try:
        main.main(args=arguments, prog_name="spavision", standalone_mode=False)
    except InputError as error:
        _stop(f"spavision: {error}", 2)
    except click.exceptions.Abort:
        _stop(
            "spavision: interrupted; the files written so far are whole, and the same command goes on "
            "without doing again the photos, pressure steps or cases that are done",
            130,
        )
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except BrokenPipeError:
        sys.exit(1)
    except Exception as error:
        if debug:
            traceback.print_exc()
        _stop(f"spavision: internal error: {type(error).__name__}: {error} (--debug shows where)", 1)
    sys.exit(0)


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,  # noqa: ARG001
    line: str | None = None,  # noqa: ARG001
) -> None:
    """Show what the user should know in one sentence, and other warnings not at all unless debugging."""
    if issubclass(category, InputWarning):
        click.echo(f"spavision: note: {message}", err=True)
    elif "--debug" in sys.argv:
        click.echo(f"{filename}:{lineno}: {category.__name__}: {message}", err=True)


def _stop(sentence: str, code: int) -> NoReturn:
    click.echo(" ".join(sentence.split()), err=True)
    sys.exit(code)
