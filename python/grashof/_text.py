"""Values of Python as a model file has them."""

from __future__ import annotations

import json
import math
import numbers
import operator
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


#: Dimensions of pint that mechanisms have, with the SI units of pint and of a model file.
_DIMENSIONS = {"[length]": ("meter", "m"), "[mass]": ("kilogram", "kg"), "[time]": ("second", "s"), "[current]": ("ampere", "A")}


def value(x: Value, name: str) -> str:
    """A value of what has a name as text; numbers in their shortest form that reads back bit for bit, quantities of pint in SI."""
    import numpy as np

    if isinstance(x, str):
        return x
    if _is_quantity(x):
        return _quantity(x, name)
    number = x.item() if isinstance(x, np.ndarray) and x.ndim == 0 else x
    if isinstance(number, bool) or not isinstance(number, numbers.Real):
        raise TypeError(f"`{name}`: a value is a text as in a model file, or a number in SI, and not {x!r}")
    if not math.isfinite(number):
        raise ValueError(f"`{name}`: {x!r} is no finite number")
    return repr(float(number))


def is_number(x: Value) -> bool:
    """Whether a value is a number in SI, and neither a text nor a quantity."""
    return not isinstance(x, str) and not _is_quantity(x)


def _is_quantity(x: Any) -> bool:
    return hasattr(x, "dimensionality") and hasattr(x, "magnitude")


def _quantity(x: Any, name: str) -> str:
    """A quantity of pint with its unit, so that its dimension is looked at; whatever the base units of its registry are."""
    powers = {str(dimension): power for dimension, power in x.dimensionality.items()}
    others = sorted(set(powers) - set(_DIMENSIONS))
    if others:
        help = "give a quantity of length, mass, time and current"
        raise ModelError(f"`{name}` is {x}, of the dimension {' '.join(others)}; {help}", code="wrong-dimension", help=help)
    of_pint = " * ".join(f"{_DIMENSIONS[dimension][0]}**{power}" for dimension, power in powers.items())
    unit = " ".join(_DIMENSIONS[dimension][1] + ("" if power == 1 else f"^{power:g}") for dimension, power in powers.items())
    return f"{value(x.to(of_pint or 'dimensionless').magnitude, name)} {unit}".rstrip()


def settings(first: Mapping[str, Value] | None, more: Mapping[str, Value]) -> List[Tuple[str, str]]:
    """Names with values as text."""
    return [(name, value(x, name)) for name, x in {**(first or {}), **more}.items()]


def values(x: Any, name: str) -> str:
    """The values of a swept parameter: a list, a distribution, a range as it stands in a file (``{"from": 0.3, "to": 0.8, "count": 26}``),
    or text as the program takes it (``"0.3..0.8:26"``, ``"30 cm, 40 cm"``)."""
    if isinstance(x, (str, Distribution)):
        return str(x)
    if isinstance(x, Mapping):
        return _range(x, name)
    return ",".join(value(each, name) for each in _some(_each(x), name))


def _range(x: Mapping[str, Any], name: str) -> str:
    """Values as a model file has them, with keys."""
    keys = set(x)
    if keys in ({"from", "to", "count"}, {"from", "to", "count", "log"}):
        log = ":log" if x.get("log") else ""
        return f"{value(x['from'], name)}..{value(x['to'], name)}:{x['count']}{log}"
    for kind in ("normal", "uniform"):
        if keys == {kind}:
            return f"{kind}({', '.join(value(each, name) for each in _each(x[kind]))})"
    help = 'give a list, or a range as `{"from": 0.3, "to": 0.8, "count": 26}`'
    raise ModelError(f"the values of `{name}` are {x!r}; {help}", code="bad-range", help=help)


def axes(over: Any) -> List[Tuple[str, str]]:
    """Swept parameters with their values; several parameters together, ``("l1", "l3")``, with points, a row each, as a frame has them."""
    if _is_frame(over):
        over = {tuple(over.columns): over}
    if not isinstance(over, Mapping):
        raise TypeError(f"`over` has for each parameter its values, and is not {over!r}")
    return [(names, values(x, names)) if isinstance(names, str) else (",".join(_names(names)), _points(names, x)) for names, x in over.items()]


def _names(names: Any) -> Tuple[str, ...]:
    if isinstance(names, tuple) and names and all(isinstance(name, str) for name in names):
        return names
    raise TypeError(f"a swept parameter is a name, or several are names, and not {names!r}")


def _points(names: Sequence[str], points: Any) -> str:
    """Points by the names of their parameters, where they have these, or by their order."""
    if _is_frame(points):
        missing = [name for name in names if name not in points.columns]
        if missing:
            help = f"give a column for each of {', '.join(f'`{name}`' for name in names)}"
            raise ModelError(f"the frame of points has no column `{missing[0]}`; {help}", code="uneven-points", help=help)
        points = points[list(names)]
    if isinstance(points, Mapping):
        raise TypeError(f"points are rows, and not {points!r}")
    rows = _some(_each(points), ", ".join(names))
    return (", " if len(names) == 1 else "; ").join(",".join(map(value, _row(names, place, row), names)) for place, row in enumerate(rows))


def _row(names: Sequence[str], place: int, row: Any) -> Sequence[Any]:
    """The values of a point."""
    if isinstance(row, Mapping) and set(row) == set(names):
        return [row[name] for name in names]
    if isinstance(row, (str, Mapping)) or not hasattr(row, "__len__") or len(row) != len(names):
        help = f"give a row for each point, with {len(names)} values: of {', '.join(f'`{name}`' for name in names)}"
        raise ModelError(f"point {place} is {row!r}; {help}", code="uneven-points", help=help)
    return list(row)


def _is_frame(x: Any) -> bool:
    """Whether something is a table with named columns."""
    return hasattr(x, "columns") and hasattr(x, "to_numpy")


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


def whole(x: Any, name: str, least: int, wanted: str = "a whole number") -> int:
    """A whole number of 64 bits that is not below another."""
    try:
        number = operator.index(x)
    except TypeError:
        raise TypeError(f"`{name}` is {wanted}, and not {x!r}") from None
    if not least <= number < 2**64:
        raise ValueError(f"`{name}` is {wanted} of at least {least} and below 2^64, and not {x!r}")
    return number


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
    """What JSON does not know: arrays and numbers of NumPy, quantities of pint, mappings, other sequences."""
    import numpy as np

    if _is_quantity(x):
        return list(x) if np.ndim(x.magnitude) else _quantity(x, "quantity")
    if isinstance(x, (np.ndarray, np.generic)):
        return x.tolist()
    if isinstance(x, Mapping):
        return dict(x)
    if isinstance(x, os.PathLike):
        return os.fspath(x)
    if hasattr(x, "__iter__"):
        return list(x)
    raise TypeError(f"{x!r} has no form in a model file")
