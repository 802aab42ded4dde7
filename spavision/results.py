"""The folder a run writes: whole files only, nothing overwritten unasked, settings kept with results."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from spavision.errors import InputError

RECORD_NAME = "run.json"
UNFINISHED_NAME = ".unfinished"

PACKAGES_THAT_COMPUTE = (
    "spavision",
    "numpy",
    "scipy",
    "opencv-python-headless",
    "scikit-fem",
    "numba",
    "pypardiso",
    "pandas",
)


class ResultsFolder:
    """Writes the files of one run.

    Each file is written under a temporary name and renamed when it is whole, so an interrupted run leaves no
    half file. The record ``run.json`` lists the files that the run wrote; a later run with ``force`` removes
    just those before it writes its own, and leaves everything else in the folder alone.

    Parameters
    ----------
    path : Path
        The folder; made when it does not exist.
    force : bool
        Whether an earlier run's files may be replaced.

    Raises
    ------
    InputError
        If the folder holds something already and ``force`` is off, or cannot be written to.
    """

    def __init__(self, path: Path, *, force: bool = False) -> None:
        self.path = path
        self._written: list[str] = []
        self._inputs: dict[Path, str] = {}
        if path.exists() and not path.is_dir():
            raise InputError(f"--output {path}: is a file, expected a folder; choose another name")
        if path.is_dir() and any(each.name != UNFINISHED_NAME for each in path.iterdir()) and not force:
            raise InputError(
                f"--output {path}: holds files already; choose another folder or add --force to replace them"
            )
        self._refuse_unwritable()

    def _refuse_unwritable(self) -> None:
        existing = next(folder for folder in (self.path, *self.path.absolute().parents) if folder.exists())
        try:
            with tempfile.TemporaryFile(dir=existing):
                pass
        except OSError as error:
            raise InputError(
                f"--output {self.path}: cannot be written to ({error.strerror}); choose another folder"
            ) from error

    @property
    def unfinished(self) -> Path:
        """Folder for what an interrupted run leaves to the next; it goes when the record is written."""
        return self.path / UNFINISHED_NAME

    def forget_unfinished(self) -> None:
        """Remove what an interrupted run left, and the results folder where it holds nothing else."""
        shutil.rmtree(self.unfinished, ignore_errors=True)
        if self.path.is_dir() and not any(self.path.iterdir()):
            self.path.rmdir()

    def write(self, name: str, writer: Callable[[Path], object]) -> Path:
        """Write one file through ``writer``, which gets a temporary path with the same ending.

        Returns
        -------
        Path
            The finished file.
        """
        target = self.path / name
        if not self._written:
            self._remove_earlier_run()
        target.parent.mkdir(parents=True, exist_ok=True)
        temporary = target.with_name(f".partial-{os.getpid()}-{target.name}")
        try:
            writer(temporary)
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)
        self._written.append(name)
        return target

    def write_bytes(self, name: str, content: bytes) -> Path:
        """Write one file with the given content."""
        return self.write(name, lambda path: path.write_bytes(content))

    def write_text(self, name: str, text: str) -> Path:
        """Write one text file in UTF-8."""
        return self.write_bytes(name, text.encode("utf-8"))

    def adopt(self, folder: Path) -> None:
        """Take into the record the files that a series writer has finished below ``folder``."""
        files = sorted(path for path in folder.rglob("*") if path.is_file())
        self._written += [path.relative_to(self.path).as_posix() for path in files]

    def record_inputs(self, paths: Iterable[Path]) -> list[str]:
        """Take files that the run reads into the record, and return the SHA-256 digest of each."""
        digests = {path: sha256(path) for path in paths}
        self._inputs |= digests
        return list(digests.values())

    def take_over(self, other: ResultsFolder) -> None:
        """Take in the inputs that another folder has recorded, and copies of the files written there."""
        self._inputs |= other._inputs
        for name in other._written:
            self.write_bytes(name, (other.path / name).read_bytes())

    def write_record(self, record: Mapping[str, Any]) -> Path:
        """Write ``run.json``: the given record, inputs, package versions and the list of files written."""
        content = {
            **record,
            "inputs": self._inputs_by_name(),
            "versions": versions(),
            "files": sorted({*self._written, RECORD_NAME}),
        }
        self.forget_unfinished()
        return self.write_text(RECORD_NAME, json.dumps(content, indent=2, ensure_ascii=False) + "\n")

    def _inputs_by_name(self) -> dict[str, str]:
        """Return the digests by file name, or by path where two files share a name."""
        names = Counter(path.name for path in self._inputs)
        return {
            path.name if names[path.name] == 1 else path.as_posix(): digest
            for path, digest in self._inputs.items()
        }

    def _remove_earlier_run(self) -> None:
        for name in _files_of_earlier_run(self.path / RECORD_NAME):
            earlier = (self.path / name).resolve()
            if earlier.is_relative_to(self.path.resolve()):
                earlier.unlink(missing_ok=True)


def _files_of_earlier_run(record: Path) -> Iterable[str]:
    try:
        content = json.loads(record.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []
    files = content.get("files", []) if isinstance(content, dict) else []
    return [name for name in files if isinstance(name, str)]


def versions() -> dict[str, str]:
    """Return the versions of Python and of the packages that a result depends on."""
    found = {"python": platform.python_version()}
    for name in PACKAGES_THAT_COMPUTE:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def sha256(path: Path) -> str:
    """Return the SHA-256 digest of a file, read piece by piece: a video may be larger than the memory.

    Raises
    ------
    InputError
        If the file cannot be read.
    """
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); check its permissions") from error
