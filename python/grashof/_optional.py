"""Packages that are imported when they are asked for."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import Refused


def package(name: str, what: str, install: str = "") -> Any:
    """A package, or a module of one, that does something; raises :class:`Refused` if it is not installed.

    ``install`` is its name for pip, if that is another one.
    """
    root = name.split(".")[0]
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as missing:
        # what it lacks itself is to be told as it is
        if missing.name not in (root, name):
            raise
        help = f"pip install {install or root}"
        message = f"{what} by the package `{install or root}`, which is not installed; {help}"
        raise Refused(message, code="no-package", help=help) from None
