"""The layout that design and packaging rely on: which folder may import which."""

import ast
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

FORBIDDEN = {
    "model": (
        "spavision.vision",
        "spavision.cli",
        "spavision.workflow",
        "spavision.correlate",
        "spavision.render",
        "spavision.experiment",
    ),
    "spavision/vision": (
        "spavision.model",
        "spavision.cli",
        "spavision.workflow",
        "spavision.correlate",
        "spavision.render",
    ),
    "spavision/render": (
        "spavision.model",
        "spavision.cli",
        "spavision.workflow",
        "spavision.correlate",
        "spavision.vision",
    ),
    "correlate": ("spavision.cli", "spavision.workflow", "spavision.render"),
    "spavision/workflow": ("spavision.cli", "spavision.render"),
}


def absolute_imports(path: Path) -> set[str]:
    """Return the dotted names that a module imports absolutely."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names.add(node.module)
    return names


def modules_below(folder: str) -> list[Path]:
    found = sorted((ROOT / folder).rglob("*.py"))
    assert found, f"no module below {folder}"
    return found


@pytest.mark.parametrize("folder", ["model", "correlate", "spavision"])
def test_nothing_imports_the_bare_folder_names(folder):
    for path in modules_below(folder):
        first_names = {name.split(".")[0] for name in absolute_imports(path)}
        assert not first_names & {"model", "correlate"}, path


@pytest.mark.parametrize("folder", FORBIDDEN)
def test_dependencies_run_one_way(folder):
    for path in modules_below(folder):
        wrong = [name for name in absolute_imports(path) if name.startswith(FORBIDDEN[folder])]
        assert not wrong, f"{path.relative_to(ROOT)} imports {wrong}"


def test_every_package_is_in_the_wheel():
    listed = set(
        tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]["packages"]
    )
    installed_as = {"spavision": "spavision", "model": "spavision.model", "correlate": "spavision.correlate"}
    for folder, name in installed_as.items():
        for marker in sorted((ROOT / folder).rglob("__init__.py")):
            parts = marker.parent.relative_to(ROOT / folder).parts
            assert ".".join((name, *parts)) in listed
