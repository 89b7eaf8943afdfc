"""Values of Python as a model file has them."""

from __future__ import annotations

import json
import numbers
import os
from typing import Any, Iterable, List, Mapping, NamedTuple, Tuple, Union

import numpy as np

from . import _grashof

#: A value of a parameter: text as in a model file (``"60 cm"``, ``"l1/2"``), a number in SI, or a quantity of pint.
Value = Union[str, float, int, "np.floating[Any]", "np.integer[Any]", Any]
#: The path of a file.
Path = Union[str, "os.PathLike[str]"]


class Distribution(NamedTuple):
    """What the values of a parameter are drawn from, as the program takes it."""

    #: As the program takes it: ``normal(0.15, 0.0001)``.
    text: str

    def __str__(self) -> str:
        return self.text


def value(x: Value) -> str:
    """A value as text; numbers in their shortest form that reads back bit for bit."""
    if isinstance(x, str):
        return x
    if hasattr(x, "to_base_units"):
        x = x.to_base_units().magnitude
    if isinstance(x, bool) or not isinstance(x, numbers.Real):
        raise TypeError(f"a value is a text as in a model file, or a number in SI, and not {x!r}")
    return repr(float(x))


def settings(first: Mapping[str, Value] | None, more: Mapping[str, Value]) -> List[Tuple[str, str]]:
    """Names with values as text."""
    return [(name, value(x)) for name, x in {**(first or {}), **more}.items()]


def values(x: Any) -> str:
    """The values of a swept parameter: a list, a distribution, or text as the program takes it (``"0.3..0.8:26"``, ``"30 cm, 40 cm"``)."""
    if isinstance(x, (str, Distribution)):
        return str(x)
    return ",".join(value(each) for each in _each(x))


def axes(over: Mapping[Any, Any]) -> List[Tuple[str, str]]:
    """Swept parameters with their values; several parameters together, ``("l1", "l3")``, with points, a row each."""
    return [(names, values(x)) if isinstance(names, str) else (",".join(names), _points(names, x)) for names, x in over.items()]


def _points(names: Any, points: Any) -> str:
    rows = points.tolist() if isinstance(points, np.ndarray) else points
    return (", " if len(names) == 1 else "; ").join(",".join(value(x) for x in row) for row in rows)


def _each(x: Any) -> Iterable[Any]:
    if isinstance(x, np.ndarray):
        return [float(each) for each in x.ravel()]
    return x if hasattr(x, "__iter__") and np.ndim(x) > 0 else [x]


def text(sections: Mapping[str, Any]) -> str:
    """A model, or a part of one, as YAML."""
    return _grashof.yaml(json.dumps(sections, default=_plain, ensure_ascii=False, allow_nan=False))


def _plain(x: Any) -> Any:
    """What JSON does not know: arrays and numbers of NumPy, mappings, other sequences."""
    if isinstance(x, (np.ndarray, np.generic)):
        return x.tolist()
    if isinstance(x, Mapping):
        return dict(x)
    if isinstance(x, os.PathLike):
        return os.fspath(x)
    if hasattr(x, "__iter__"):
        return list(x)
    raise TypeError(f"{x!r} has no form in a model file")
