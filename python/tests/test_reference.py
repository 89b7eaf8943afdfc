"""The reference of the package is what its sources give."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from common import ROOT

import grashof

PAGE = ROOT / "docs" / "python-reference.md"


def test_the_page_is_current() -> None:
    done = subprocess.run([sys.executable, ROOT / "python" / "reference.py", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_everything_public_is_there() -> None:
    headings = re.findall(r"^### (.*)$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(headings) == sorted(grashof.__all__)


@pytest.mark.parametrize("name", grashof.__all__)
def test_all_members_are_there(name: str) -> None:
    text = PAGE.read_text(encoding="utf-8")
    about = re.split(r"^###? ", text.split(f"\n### {name}\n")[1], maxsplit=1, flags=re.MULTILINE)[0]
    public = getattr(grashof, name)
    members = [key for key in vars(public) if not key.startswith("_")] if isinstance(public, type) else []
    for key in members:
        assert f"#### `{name}.{key}`\n" in about or f"| `{key}` |" in about, key


def test_links_lead_somewhere() -> None:
    text = PAGE.read_text(encoding="utf-8")
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    anchors = [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings]
    assert len(set(anchors)) == len(anchors)
    assert set(re.findall(r"\]\(#([^)]*)\)", text)) <= set(anchors)
