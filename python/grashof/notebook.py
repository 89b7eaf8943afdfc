"""What a notebook shows of results."""

from __future__ import annotations

import base64
import html
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .results import Results


def results_html(results: Results) -> str:
    """The summary, and the figures of the study."""
    summary = f"<pre><b>{html.escape(results.study)}</b>\n{html.escape(results.summary())}</pre>"
    return summary + "".join(_image(name, svg) for name, svg in results._core.figures_svg())


def _image(name: str, svg: str) -> str:
    data = base64.b64encode(svg.encode()).decode()
    return f'<img alt="{html.escape(name)}" src="data:image/svg+xml;base64,{data}" style="max-width: 100%; width: 700px; display: block">'
