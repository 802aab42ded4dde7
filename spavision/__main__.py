"""Run the command line with ``python -m spavision``."""

from spavision.cli.main import run

run()
