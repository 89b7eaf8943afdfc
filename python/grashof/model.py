"""Model files and their studies."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Literal, Mapping, Optional, Sequence, Tuple, Union, overload

from . import _grashof, _text
from . import functions as _functions
from .builder import Model
from .compared import Compared
from .dynamics import Dynamics
from .errors import Fault, Refused
from .functions import Function, Functions
from .page import Page
from .records import unknown
from .results import Results
from .stepper import Stepper

if TYPE_CHECKING:
    from .gathered import SweepTable
    from .sensitivity import Sensitivity

__all__ = ["LoadedModel", "Study", "load", "parse"]


def load(source: Union[_text.Path, Mapping[str, Any], Model], functions: Optional[Functions] = None) -> LoadedModel:
    """Reads a model: the path of a file, with what it includes; a text of several lines, as :func:`parse`; or a mechanism in code, as a
    mapping with the keys of a file.
    ``functions`` are functions of Python that its expressions may call, by their names there.

    Nothing is checked but the form of the file: raises :class:`ModelError` if it cannot be read or is no YAML. What is wrong with the
    mechanism, a key or a study is told by :meth:`LoadedModel.check`, and by an exception when these are asked for.

    >>> model = grashof.load("crank_rocker.yaml")
    >>> model.check()                       # an empty list if nothing is wrong
    """
    if isinstance(source, Model):
        return source.load() if functions is None else source.load().with_functions(functions)
    if isinstance(source, Mapping):
        return parse(_text.text(source), functions)
    path = os.fspath(source)
    return parse(path, functions) if "\n" in path else _with(_grashof.load(path), functions)


def parse(text: str, functions: Optional[Functions] = None) -> LoadedModel:
    """A model that stands in a text and includes no files; raises :class:`ModelError` if that is no YAML, and checks no more, as
    :func:`load`. ``functions`` as there."""
    return _with(_grashof.parse(text), functions)


def _with(core: _grashof.Model, functions: Optional[Functions]) -> LoadedModel:
    known = _functions.known(functions)
    return LoadedModel(core.with_functions(_functions.described(known)) if known else core, known)


def _unpacked(packed: str, functions: Dict[str, Function]) -> LoadedModel:
    """A model that was pickled."""
    return _with(_grashof.unpack(packed), functions)


class LoadedModel:
    """A model file with variants applied and parameters set: a mechanism, and studies of it. It never changes.

    It can be pickled, with the files that it includes, and sent to other processes and machines.
    """

    def __init__(self, core: _grashof.Model, functions: Optional[Dict[str, Function]] = None) -> None:
        self._core = core
        self._functions = functions or {}

    def __reduce__(self) -> Tuple[Any, Tuple[Any, ...]]:
        return _unpacked, (self._core.pack(), self._functions)

    def __repr__(self) -> str:
        return f"<model with the studies {', '.join(self.studies) or 'none'}>"

    @property
    def text(self) -> str:
        """The text of the file."""
        return self._core.text

    @property
    def studies(self) -> List[str]:
        """Names of the studies, in file order."""
        return self._core.studies

    @property
    def variants(self) -> List[str]:
        """Names of the variants, in file order."""
        return self._core.variants

    @property
    def functions(self) -> Dict[str, Function]:
        """Functions of Python that its expressions may call, by their names."""
        return dict(self._functions)

    def with_functions(self, functions: Optional[Functions] = None, /, **named: Union[Function, Callable[..., Any]]) -> LoadedModel:
        """A new model whose expressions may call functions of Python, beside those that it has.

        A call takes some two microseconds, in a sweep with several threads ten times that: as long as dozens of expressions, and calls
        from several threads wait for each other.

        >>> m.with_functions(gas=grashof.Function(gas, switches={"late": "angle > 213 deg"}))
        """
        known = {**self._functions, **_functions.known({**(functions or {}), **named})}
        return LoadedModel(self._core.with_functions(_functions.described(known)), known)

    @property
    def parameters(self) -> Dict[str, float]:
        """Parameters with their values, SI, in file order."""
        return {name: value for name, value, _ in self._core.parameters()}

    @property
    def units(self) -> Dict[str, str]:
        """The SI units of the parameters; empty for a number."""
        return {name: unit for name, _, unit in self._core.parameters()}

    def set(self, values: Optional[Mapping[str, _text.Value]] = None, /, **named: _text.Value) -> LoadedModel:
        """A new model with parameters at other values: text as in the file, or numbers in SI. They stand over what variants and
        studies say.

        >>> m.set(l3="60 cm", l1=0.15)
        """
        return LoadedModel(self._core.set(_text.settings(values, named)), self._functions)

    def variant(self, *names: str) -> LoadedModel:
        """A new model with variants of the file; a study applies its own first."""
        core = self._core
        for name in names:
            core = core.variant(name)
        return LoadedModel(core, self._functions)

    def check(self) -> List[Fault]:
        """All that is wrong with the model, with each of its variants and studies; empty if nothing is."""
        return self._core.check()

    def study(self, name: str) -> Study:
        """A study by its name; raises :class:`UnknownName` if there is none."""
        if name not in self.studies:
            raise unknown("study", name, self.studies)
        return Study(self, name)

    def run(self, study: str, values: Optional[Mapping[str, _text.Value]] = None, /, **named: _text.Value) -> Results:
        """Runs a study, with parameters at other values, and first those from which it takes scalars. Values are given by keyword, or
        as a mapping. What the file expects of its own values is judged if none are changed.

        A motion that stops on its way has results up to there, with :attr:`Results.stopped`; so has a sweep of which runs fail.
        Raises :class:`StudyError` if the study does not begin.
        """
        return self._run(study, {}, None, _text.settings(values, named))

    @overload
    def sweep(
        self,
        study: str,
        over: Any,
        *,
        workers: Optional[int] = None,
        values: Optional[Mapping[str, _text.Value]] = None,
        samples: Optional[int] = None,
        seed: int = 1,
    ) -> Results: ...
    @overload
    def sweep(
        self,
        study: str,
        over: Any,
        *,
        workers: Literal["ray"],
        values: Optional[Mapping[str, _text.Value]] = None,
        samples: Optional[int] = None,
        seed: int = 1,
        into: _text.Path,
        address: Optional[str] = None,
        progress: Optional[Callable[[int, int], object]] = None,
    ) -> SweepTable: ...
    def sweep(
        self,
        study: str,
        over: Any,
        *,
        workers: Union[int, Literal["ray"], None] = None,
        values: Optional[Mapping[str, _text.Value]] = None,
        samples: Optional[int] = None,
        seed: int = 1,
        into: Optional[_text.Path] = None,
        address: Optional[str] = None,
        progress: Optional[Callable[[int, int], object]] = None,
    ) -> Union[Results, SweepTable]:
        """Runs a study for all combinations of values of parameters; the last parameter goes fastest.

        ``over`` has for each parameter its values: numbers in SI or texts, or a range with the keys of a file. Several parameters
        together run through points, a row each: lists, mappings, a frame. A frame in the place of ``over`` has a run for each row.
        The results have a row a run: the parameters and the scalars of the study. ``workers`` are threads, all processors if omitted;
        the numbers are the same for any.

        >>> m.sweep("one-turn", over={"l3": np.linspace(0.4, 0.7, 31), "load_max": [0, 3000]})
        >>> m.sweep("one-turn", over={("l1", "l3"): [[0.15, 0.5], [0.16, 0.55]]})

        Values may be drawn: ``samples`` points, all parameters with a distribution at once, on which ``seed`` decides;
        :attr:`Results.statistics` says how the scalars are distributed.

        >>> m.sweep("one-turn", over={"l3": grashof.normal("55 cm", "1 mm")}, samples=1000)

        With ``workers="ray"`` runs are computed on the cluster of an ``address``, by default that to which the program is connected, or
        one of this machine alone. Finished runs are kept ``into`` a directory, from which the same call goes on after an interrupt; the
        table is gathered there in a file, with the bytes that the results of one process give. ``progress`` is called with the number
        of finished runs, and of all.

        >>> m.sweep("one-turn", over={"l3": np.linspace(0.4, 0.7, 10**5)}, workers="ray", into="lengths")
        """
        drawn = None if samples is None else (_text.whole(samples, "samples", 1), _text.whole(seed, "seed", 0))
        if workers != "ray":
            workers = None if workers is None else _text.whole(workers, "workers", 1, 'a number of threads, or "ray"')
            if into is not None or address is not None or progress is not None:
                raise TypeError("`into`, `address` and `progress` go with `workers=\"ray\"`")
            return self._run(study, over, workers, _text.settings(values, {}), drawn)
        if into is None:
            raise TypeError("name the directory for the runs, `into`")
        from .distributed import sweep

        core = self.set(values)._core if values else self._core
        return sweep(core, self._functions, study, _text.axes(over), drawn, address=address, into=into, progress=progress)

    def sensitivity(
        self,
        study: str,
        over: Mapping[str, _text.Distribution],
        *,
        samples: int = 1024,
        seed: int = 1,
        confidence: float = 0.95,
        values: Optional[Mapping[str, _text.Value]] = None,
        workers: Union[int, Literal["ray"], None] = None,
        **cluster: Any,
    ) -> Sensitivity:
        """Sobol's indices of the scalars of a study: which share of their variance each parameter with a distribution has, alone and with
        what it does together with others.

        The study is run at ``samples`` × (parameters + 2) points, those of Saltelli; ``samples`` is a power of two. The indices are those
        of SALib. With ``workers="ray"`` as :meth:`LoadedModel.sweep`, with ``into``, ``address`` and ``progress``.

        >>> m.sensitivity("one-turn", over={"l1": grashof.normal("15 cm", "1 mm"), "l3": grashof.uniform("54 cm", "56 cm")})
        """
        from .sensitivity import indices, points

        if not over:
            help = "give parameters with their distributions"
            raise Refused(f"no parameter varies; {help}", code="refused", help=help)
        if not 0 < confidence < 1:
            help = "give a part of 1, as 0.95"
            raise Refused(f"{confidence!r} is no confidence; {help}", code="refused", help=help)
        model = self.set(values) if values else self
        names = list(over)
        at = points(model._core, study, _text.axes(over), _text.whole(samples, "samples", 1), _text.whole(seed, "seed", 0))
        runs = model.sweep(study, {tuple(names): at}, workers=workers, **cluster)
        return indices(runs, names, seed, confidence)

    def _run(
        self,
        study: str,
        over: Mapping[Any, Any],
        workers: Optional[int],
        settings: Any,
        samples: Optional[Tuple[int, int]] = None,
    ) -> Results:
        core = self._core.set(settings) if settings else self._core
        return Results(core.run(study, _text.axes(over), workers, samples), core)

    def solve(self, study: str, values: Optional[Mapping[str, _text.Value]] = None, /, **named: _text.Value) -> Results:
        """Runs a study with a section ``solve``; :attr:`Results.solution` is the value of the parameter that meets the target."""
        results = self.run(study, values, **named)
        if results.solution is None and not any(run.solution for run in results.runs.whole()):
            raise Refused(f"study `{study}` solves nothing; add a section `solve` to it", code="refused", help="add a section `solve` to it")
        return results

    def statics(self, study: Optional[str] = None, **keys: Any) -> Results:
        """Equilibria: of a study of the file, or of one with these keys, ``from="start"`` if none are given."""
        return self._kind("statics", study, keys or {"from": "start"})

    def modes(self, study: Optional[str] = None, **keys: Any) -> Results:
        """Vibrations: of a study of the file, or of one with these keys, as ``at="statics", damped=True, lowest=5``."""
        return self._kind("modes", study, {"at": "start", **keys})

    def linearize(self, study: Optional[str] = None, **keys: Any) -> Results:
        """The linear system of small deviations, :attr:`Results.linear`: of a study of the file, or of one with these keys, as
        ``at="statics", inputs=["push"]``; ``columns`` are its outputs."""
        return self._kind("linearize", study, keys)

    def _kind(self, kind: str, study: Optional[str], keys: Dict[str, Any]) -> Results:
        if study is None:
            columns = {"columns": keys.pop("columns")} if "columns" in keys else {}
            return self._added(kind, {kind: keys, **columns})
        results = self.run(study)
        if results.kind != kind:
            raise Refused(f"study `{study}` is of the kind `{results.kind}`, not `{kind}`", code="refused", help=f"name a study of the kind `{kind}`")
        return results

    def _added(self, name: str, study: Mapping[str, Any]) -> Results:
        model, name = self.with_study(name, study)
        return model.run(name)

    def with_study(self, name: str, study: Mapping[str, Any]) -> tuple[LoadedModel, str]:
        """A new model with one more study, a mapping as it would stand in the file; and its name, which is the first of ``name``,
        ``name-2``, ... that no study has.

        >>> m, name = m.with_study("slow", {"inverse": {"over": "1 turn", "samples": 72}, "set": {"speed": "60 rpm"}, "columns": ["drive.torque"]})
        """
        core, name = self._core.with_study(name, _text.text(study))
        return LoadedModel(core, self._functions), name

    def compare(
        self,
        study: str,
        integrators: Union[str, Sequence[str]],
        tolerances: Union[float, Sequence[float], None] = None,
        *,
        steps: Union[float, Sequence[float], None] = None,
    ) -> Compared:
        """Computes a motion in time by several integrators, at several tolerances or with fixed steps of several sizes, s: errors,
        times and counts of each. One integrator, tolerance or step may stand without a list.

        >>> m.compare("start-up", integrators=["dop853", "radau5"], tolerances=[1e-6, 1e-9]).to_pandas()
        """
        if (tolerances is None) == (steps is None):
            raise TypeError("give either `tolerances` or `steps`")
        sizes = _text.sizes(tolerances, "tolerances") if steps is None else _text.sizes(steps, "steps")
        names = [integrators] if isinstance(integrators, str) else list(integrators)
        return Compared(self._core.compare(study, names, sizes, steps is not None))

    def dynamics(self) -> Dynamics:
        """The equations of motion of the mechanism, assembled at its start."""
        return Dynamics(self._core.dynamics())

    def stepper(self, study: str) -> Stepper:
        """The motion of a study of the kind ``dynamics``, to be advanced step by step by the integrator of the study; what events change
        is followed.

        Raises :class:`Refused` for a study of another kind.
        """
        return Stepper(self._core.stepper(study), self._core)

    def report(self, *results: Results) -> Page:
        """The page of a report on results of its studies: figures, tables, the mechanism in motion."""
        return Page(self._core.report([each._core for each in results]).decode())


class Study:
    """A study of a model file."""

    def __init__(self, model: LoadedModel, name: str) -> None:
        #: The model.
        self.model: LoadedModel = model
        #: Name of the study.
        self.name: str = name

    def __repr__(self) -> str:
        return f"<study {self.name}>"

    def set(self, values: Optional[Mapping[str, _text.Value]] = None, /, **named: _text.Value) -> Study:
        """The study of a new model with parameters at other values."""
        return Study(self.model.set(values, **named), self.name)

    def run(self, values: Optional[Mapping[str, _text.Value]] = None, /, **named: _text.Value) -> Results:
        """:meth:`LoadedModel.run` of this study."""
        return self.model.run(self.name, values, **named)

    def sweep(
        self,
        over: Any,
        *,
        workers: Optional[int] = None,
        values: Optional[Mapping[str, _text.Value]] = None,
        samples: Optional[int] = None,
        seed: int = 1,
    ) -> Results:
        """:meth:`LoadedModel.sweep` of this study, on this machine."""
        return self.model.sweep(self.name, over, workers=workers, values=values, samples=samples, seed=seed)
