"""Ray, which is imported when it is asked for."""

from __future__ import annotations

import logging
import os
import time
from contextlib import contextmanager
from typing import Any, Dict, Iterator, NamedTuple, Optional, Tuple

from . import _grashof, _optional
from .errors import Refused
from .functions import Function, described

__all__ = ["Task", "compute", "connected"]


class Task(NamedTuple):
    """A sweep as it goes over to the machines of a cluster."""

    #: Says which sweep it is.
    fingerprint: str
    #: Of the package.
    version: str
    #: The model with the files that it names.
    model: str
    #: Functions of Python that it calls.
    functions: Dict[str, Function]
    study: str
    over: Tuple[Tuple[str, str], ...]
    samples: Optional[Tuple[int, int]]

    def prepare(self) -> _grashof.Sweep:
        """The sweep, to be computed part by part."""
        if self.version != _grashof.version:
            message = f"a machine of the cluster has the version {_grashof.version} of the package, and not {self.version}"
            raise Refused(message, code="refused", help="install the same version on all of them")
        model = _grashof.unpack(self.model)
        if self.functions:
            model = model.with_functions(described(self.functions))
        return model.prepare(self.study, self.over, self.samples, 1)


class _Last:
    """The sweep of which this process has computed last."""

    fingerprint = ""
    sweep: Optional[_grashof.Sweep] = None


def compute(task: Task, first: int, end: int) -> Tuple[bytes, float]:
    """The table of some runs as the bytes of a Parquet file, and how long they took, s."""
    if _Last.sweep is None or _Last.fingerprint != task.fingerprint:
        _Last.sweep, _Last.fingerprint = task.prepare(), task.fingerprint
    begin = time.perf_counter()
    table = _Last.sweep.only(first, end, 1).parquet()
    return table, time.perf_counter() - begin


def ray() -> Any:
    """The package ``ray``."""
    # it is to be quiet, unless somebody has said otherwise
    for name, value in {"RAY_USAGE_STATS_ENABLED": "0", "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0"}.items():
        os.environ.setdefault(name, value)
    return _optional.package("ray", "sweeps on many machines go")


@contextmanager
def connected(address: Optional[str]) -> Iterator[Any]:
    """Ray, connected to the cluster of an address: to the one that the program is connected to already, if it is; to one of this machine
    alone, if there is no address. What was begun here ends here."""
    module = ray()
    if module.is_initialized():
        here = module.get_runtime_context().gcs_address
        if address not in (None, "auto", "local", here) and "://" not in str(address):
            help = "leave the address out, or disconnect by `ray.shutdown()` before"
            raise Refused(f"the program is connected to the cluster at `{here}`, and not to `{address}`; {help}", code="refused", help=help)
        yield module
        return
    quiet = {"log_to_driver": False, "logging_level": logging.ERROR}
    # without an address Ray would look for a cluster that somebody began on this machine, and may find one that is gone
    address = address or os.environ.get("RAY_ADDRESS") or "local"
    here = address == "local"
    try:
        module.init(address=address, **quiet, **({"include_dashboard": False} if here else {}))
    except (ConnectionError, ValueError) as why:
        message = f"there is no Ray cluster at `{address}`: {why}"
        raise Refused(message, code="no-cluster", help="start one with `ray start --head`, or leave the address out") from None
    try:
        yield module
    finally:
        module.shutdown()
