"""Results for other programs, which are imported when they are asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _optional

if TYPE_CHECKING:
    import pandas
    import xarray

    from .gathered import SweepTable
    from .results import Results


def frame(results: Results | SweepTable, copy: bool) -> pandas.DataFrame:
    """The table as a frame."""
    library = _optional.package("pandas", "frames are made")
    is_over = results.independent_name and not results.reasons
    index = library.Index(results.independent, name=results.independent_name) if is_over else None
    made: pandas.DataFrame = library.DataFrame(results.table, index=index, columns=results.columns, copy=copy)
    if results.reasons:
        made.index.name = "run"
        made["reason"] = results.reasons
    made.attrs["units"] = {name: results.units[name] for name in results.columns}
    return made


def dataset(results: Results | SweepTable) -> xarray.Dataset:
    """The table as a data set."""
    library = _optional.package("xarray", "data sets are made")
    reasons = results.reasons
    sweep = bool(reasons)
    axis = "run" if sweep else results.independent_name or "row"

    def attributes(name: str) -> dict[str, str]:
        return {"units": results.units.get(name, ""), "quantity": results.quantities.get(name, "")}

    # a column that is the independent variable itself is the coordinate
    columns = {name: (axis, results[name], attributes(name)) for name in results.columns if name != axis}
    at = results.independent if results.independent_name and not sweep else np.arange(len(results))
    made: xarray.Dataset = library.Dataset(columns, coords={axis: (axis, at, {"units": results.units.get(axis, "")})})
    if sweep:
        made["reason"] = (axis, reasons)
    made.attrs["study"] = results.study
    return made


def quantity(results: Results | SweepTable, name: str | None, registry: Any) -> Any:
    """A column with its unit, or all by their names."""
    library = _optional.package("pint", "quantities are made")
    registry = registry or library.get_application_registry()
    if name is None:
        return {each: quantity(results, each, registry) for each in results.columns}
    return registry.Quantity(results[name], results.units[name] or "dimensionless")
