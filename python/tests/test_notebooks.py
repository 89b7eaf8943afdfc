"""The notebooks of the repository run, and what they claim holds."""

from __future__ import annotations

import pathlib
from typing import Any

import nbformat
import pytest
from common import ROOT
from nbclient import NotebookClient

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))


#: nbformat has no types.
UNTYPED: Any = nbformat


def read(path: pathlib.Path) -> Any:
    return UNTYPED.read(path, as_version=4)


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) == 4


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: str(path.stem))
def test_a_notebook_is_stored_without_outputs(path: pathlib.Path) -> None:
    notebook = read(path)
    UNTYPED.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert code and all(cell.outputs == [] and cell.execution_count is None for cell in code)
    # each has claims that would fail
    assert sum("assert " in cell.source for cell in code) >= 4


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: str(path.stem))
def test_a_notebook_runs(path: pathlib.Path) -> None:
    notebook = read(path)
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}).execute()
    shown = [kind for cell in notebook.cells for output in cell.get("outputs", []) for kind in output.get("data", {})]
    assert "image/png" in shown and "text/html" in shown
