"""Values of Python as a model file has them."""

from __future__ import annotations

import json
import math
import numbers
import os
from typing import TYPE_CHECKING, Any, List, Mapping, NamedTuple, Sequence, Tuple, Union

from . import _grashof
from .errors import ModelError

if TYPE_CHECKING:
    import numpy as np

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


def value(x: Value, name: str) -> str:
    """A value of what has a name as text; numbers in their shortest form that reads back bit for bit."""
    import numpy as np

    if isinstance(x, str):
        return x
    number = x.to_base_units().magnitude if hasattr(x, "to_base_units") else x
    if isinstance(number, np.ndarray) and number.ndim == 0:
        number = number.item()
    if isinstance(number, bool) or not isinstance(number, numbers.Real):
        raise TypeError(f"`{name}`: a value is a text as in a model file, or a number in SI, and not {x!r}")
    if not math.isfinite(number):
        raise ValueError(f"`{name}`: {x!r} is no finite number")
    return repr(float(number))


def settings(first: Mapping[str, Value] | None, more: Mapping[str, Value]) -> List[Tuple[str, str]]:
    """Names with values as text."""
    return [(name, value(x, name)) for name, x in {**(first or {}), **more}.items()]


def values(x: Any, name: str) -> str:
    """The values of a swept parameter: a list, a distribution, or text as the program takes it (``"0.3..0.8:26"``, ``"30 cm, 40 cm"``)."""
    if isinstance(x, (str, Distribution)):
        return str(x)
    return ",".join(value(each, name) for each in _some(_each(x), name))


def axes(over: Mapping[Any, Any]) -> List[Tuple[str, str]]:
    """Swept parameters with their values; several parameters together, ``("l1", "l3")``, with points, a row each."""
    return [(names, values(x, names)) if isinstance(names, str) else (",".join(names), _points(names, x)) for names, x in over.items()]


def _points(names: Sequence[str], points: Any) -> str:
    rows = _some(_each(points), ", ".join(names))
    for place, row in enumerate(rows):
        if isinstance(row, str) or not hasattr(row, "__len__") or len(row) != len(names):
            help = f"give a row for each point, with {len(names)} values: of {', '.join(f'`{name}`' for name in names)}"
            raise ModelError(f"point {place} is {row!r}; {help}", code="uneven-points", help=help)
    return (", " if len(names) == 1 else "; ").join(",".join(map(value, row, names)) for row in rows)


def _each(x: Any) -> List[Any]:
    """The items of a list or array; a single value as a list of one."""
    import numpy as np

    if hasattr(x, "to_numpy"):
        x = x.to_numpy()
    if isinstance(x, np.ndarray):
        return list(np.atleast_1d(x).tolist())
    # a quantity of pint has an iterator, also where it is a single one
    single = isinstance(x, str) or not hasattr(x, "__iter__") or np.ndim(getattr(x, "magnitude", [])) == 0
    return [x] if single else list(x)


def _some(found: List[Any], name: str) -> List[Any]:
    if not found:
        raise ValueError(f"there are no values for `{name}`")
    return found


def sizes(x: Any, name: str) -> List[float]:
    """Positive numbers, or a single one."""
    found = [float(each) for each in _some(_each(x), name)]
    if not all(0 < each < math.inf for each in found):
        raise ValueError(f"`{name}` are positive numbers, and not {x!r}")
    return found


def text(sections: Mapping[str, Any]) -> str:
    """A model, or a part of one, as YAML."""
    try:
        written = json.dumps(sections, default=_plain, ensure_ascii=False, allow_nan=False)
    except ValueError as why:
        raise ValueError(f"the model has a number that is not finite, or contains itself: {why}") from None
    return _grashof.yaml(written)


def _plain(x: Any) -> Any:
    """What JSON does not know: arrays and numbers of NumPy, mappings, other sequences."""
    import numpy as np

    if isinstance(x, (np.ndarray, np.generic)):
        return x.tolist()
    if isinstance(x, Mapping):
        return dict(x)
    if isinstance(x, os.PathLike):
        return os.fspath(x)
    if hasattr(x, "__iter__"):
        return list(x)
    raise TypeError(f"{x!r} has no form in a model file")
