"""Run every benchmark with its defaults, one after the other; exit non-zero if one of them fails.

Run: python benchmarks/run_all.py [NAME ...]
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def benchmarks() -> list[Path]:
    """Return the scripts in this folder and the folders' own (``run*.py``), in order of name."""
    scripts = [path for path in sorted(FOLDER.glob("*.py")) if path != Path(__file__).resolve()]
    return scripts + sorted(FOLDER.glob("*/run*.py"))


def main(wanted: list[str]) -> int:
    """Run the benchmarks whose path holds one of the wanted words, or all."""
    failed = []
    for script in benchmarks():
        name = script.relative_to(FOLDER).as_posix()
        if wanted and not any(word in name for word in wanted):
            continue
        print(f"\n=== {name}", flush=True)
        if subprocess.run([sys.executable, script], check=False).returncode:
            failed.append(name)
    if failed:
        print(f"\nfailed: {', '.join(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
