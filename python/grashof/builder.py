"""A mechanism in code."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional

from . import _text

if TYPE_CHECKING:
    from .errors import Fault
    from .model import LoadedModel
    from .results import Results

__all__ = ["Model"]


class Model:
    """A mechanism in code: each attribute is a section of a model file, by its key there.

    >>> model = grashof.Model(name="pendulum", space="planar", gravity=[0, "-9.81 m/s^2"])
    >>> model.parameters["length"] = "1 m"
    >>> model.bodies["rod"] = {"bar": {"length": "length", "mass": "2 kg"}}
    >>> model.joints["P"] = {"revolute": ["ground", "rod.start"]}
    >>> model.save("pendulum.yaml")

    Nothing is checked here, nor by :meth:`Model.load`. What is wrong with it, with the keys that there are, is told by
    :meth:`LoadedModel.check` of the loaded model, and by an exception when something is asked of it.

    >>> model.load().check()                # an empty list if nothing is wrong
    """

    _sections: Dict[str, Any]
    #: Functions of Python that its expressions may call, by their names; no section of a file.
    functions: Dict[str, Any]

    def __init__(self, **sections: Any) -> None:
        """A mechanism with these sections."""
        self.__dict__["functions"] = dict(sections.pop("functions", {}))
        self.__dict__["_sections"] = {"grashof": 1, **sections}

    def __getattr__(self, key: str) -> Any:
        # what Python itself looks for is no section
        if key.startswith("_"):
            raise AttributeError(key)
        return self._sections.setdefault(key, {})

    def __setattr__(self, key: str, value: Any) -> None:
        if key == "functions":
            self.__dict__[key] = value
        else:
            self._sections[key] = value

    def __delattr__(self, key: str) -> None:
        del self._sections[key]

    def __repr__(self) -> str:
        return f"<mechanism in code with {', '.join(self.to_dict())}>"

    def to_dict(self) -> Dict[str, Any]:
        """The sections that are not empty, by their keys."""
        return {key: value for key, value in self._sections.items() if not (isinstance(value, dict) and not value)}

    def to_yaml(self) -> str:
        """The text of a model file."""
        return _text.text(self.to_dict())

    def save(self, path: _text.Path) -> None:
        """Writes a model file."""
        with open(os.fspath(path), "w", encoding="utf-8", newline="\n") as file:
            file.write(self.to_yaml())

    def check(self) -> List[Fault]:
        """:meth:`LoadedModel.check` of the loaded model."""
        return self.load().check()

    def run(self, study: str, values: Optional[Mapping[str, _text.Value]] = None, /, **named: _text.Value) -> Results:
        """:meth:`LoadedModel.run` of the loaded model."""
        return self.load().run(study, values, **named)

    def load(self) -> LoadedModel:
        """The model, to check and run; :meth:`LoadedModel.check` tells what is wrong with it."""
        from .model import parse

        return parse(self.to_yaml(), self.functions)
