"""Distributions from which the values of a sweep are drawn."""

from __future__ import annotations

from . import _text
from ._text import Distribution

__all__ = ["Distribution", "normal", "uniform"]


def normal(mean: _text.Value, deviation: _text.Value) -> Distribution:
    """A normal distribution: ``normal("15 cm", "0.1 mm")``; numbers are SI."""
    return Distribution(f"normal({_text.value(mean, 'mean')}, {_text.value(deviation, 'deviation')})")


def uniform(low: _text.Value, high: _text.Value) -> Distribution:
    """All values between two with the same chance: ``uniform("54 cm", "56 cm")``; numbers are SI."""
    return Distribution(f"uniform({_text.value(low, 'low')}, {_text.value(high, 'high')})")
