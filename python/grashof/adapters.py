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
    index = None if results.reasons else library.Index(results.independent, name=results.independent_name or None)
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
    at = np.arange(len(results)) if sweep else results.independent
    made: xarray.Dataset = library.Dataset(columns, coords={axis: (axis, at, {"units": results.units.get(axis, "")})})
    if sweep:
        made["reason"] = (axis, reasons)
    made.attrs["study"] = results.study
    return made


def quantity(results: Results | SweepTable, name: str, registry: Any) -> Any:
    """A column with its unit."""
    library = _optional.package("pint", "quantities are made")
    registry = registry or library.get_application_registry()
    return registry.Quantity(results[name], results.units[name] or "dimensionless")
