"""What a notebook shows: pages and pictures that move."""

from __future__ import annotations

import base64
import html
import os

from . import _text

__all__ = ["Animation", "Page"]


class Page:
    """A page of HTML that needs nothing else; a notebook shows it where it stands."""

    def __init__(self, text: str, height: int = 720) -> None:
        #: The text of the page.
        self.text: str = text
        #: How high a notebook shows it, pixels.
        self.height: int = height

    def __repr__(self) -> str:
        return f"<page of {len(self.text) // 1024} KiB; save(path) writes it>"

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self.text)}" style="width: 100%; height: {self.height}px; border: 0"></iframe>'

    def save(self, path: _text.Path) -> None:
        """Writes the page to a file."""
        with open(os.fspath(path), "w", encoding="utf-8", newline="\n") as file:
            file.write(self.text)


class Animation:
    """A mechanism in motion, an SVG that moves by itself; a notebook shows it where it stands."""

    def __init__(self, svg: str) -> None:
        #: The text of the SVG.
        self.svg: str = svg

    def __repr__(self) -> str:
        return f"<animation of {len(self.svg) // 1024} KiB; save(path) writes it>"

    def _repr_html_(self) -> str:
        # as an image, so that names inside of it meet no others
        data = base64.b64encode(self.svg.encode()).decode()
        return f'<img src="data:image/svg+xml;base64,{data}" style="max-width: 100%">'

    def save(self, path: _text.Path) -> None:
        """Writes the SVG to a file."""
        with open(os.fspath(path), "w", encoding="utf-8", newline="\n") as file:
            file.write(self.svg)
