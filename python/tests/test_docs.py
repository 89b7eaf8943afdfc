"""The page of the documentation runs as it stands there."""

from __future__ import annotations

import re

import matplotlib
import pytest
from common import ROOT

matplotlib.use("Agg")


@pytest.mark.parametrize("page", ["docs/python.md", "README.md"])
def test_code_of_a_page_runs(page: str, monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    # models are those of the repository, and files are written elsewhere
    place = tmp_path_factory.mktemp("page")
    (place / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(place)
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / page).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert blocks
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
