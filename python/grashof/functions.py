"""Functions of Python that expressions of a model call."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple, Union

__all__ = ["Function", "Functions"]


class Function:
    """A function of Python that expressions of a model may call by its name: a load, the law of a driver, a column.

    It gets numbers in SI and gives one, by default a plain one that takes the dimension of its field; ``unit`` says another (``"N m"``).
    The same arguments must give the same value.

    A formula that changes somewhere has a *switch* there. ``switches`` names them all, each with a condition on the arguments as in the
    model file; the function has one argument more for each, which is true where the condition holds. It has to compute the formula of a
    side beyond the switch as well, since a step that crosses one is cut there only when it is found. No switches, ``{}``, say that it is
    smooth. Without ``switches`` nothing is known, and results say that none is located.

    >>> def gas(angle, late):
    ...     return 0.0 if late else 3000 * np.sin(angle)
    >>> grashof.Function(gas, switches={"late": "angle > 213 deg"}, unit="N")

    Implicit integrators, vibrations and moving drivers need derivatives. They are found by differences, ten to twenty calls each, unless
    ``slopes`` gives them: functions with the same arguments, by the argument by which they are the derivative.

    ``arguments`` are the names of the arguments, where they cannot be seen from the function, as those of ``np.sin``.
    """

    def __init__(
        self,
        law: Callable[..., Any],
        *,
        switches: Optional[Mapping[str, str]] = None,
        unit: Optional[str] = None,
        slopes: Optional[Mapping[str, Callable[..., Any]]] = None,
        arguments: Optional[List[str]] = None,
    ) -> None:
        if not callable(law):
            raise TypeError(f"a function is something that can be called, and not {law!r}")
        #: What computes it.
        self.law: Callable[..., Any] = law
        #: Names of its arguments, those that say on which side of a switch it is among them.
        self.arguments: List[str] = _arguments(law) if arguments is None else [*arguments, *(switches or {})]
        #: Conditions of its switches; none if they are not known.
        self.switches: Optional[Dict[str, str]] = None if switches is None else _ordered(switches, self.arguments)
        #: Unit of its value.
        self.unit: Optional[str] = unit
        #: Its derivatives by arguments.
        self.slopes: Dict[str, Callable[..., Any]] = dict(slopes or {})
        unknown = [name for name in self.slopes if name not in self.arguments or name in (switches or {})]
        if unknown:
            raise TypeError(f"a slope by `{unknown[0]}`, which is no argument: {', '.join(self.arguments)}")

    def __call__(self, *arguments: Any) -> Any:
        return self.law(*arguments)

    def __repr__(self) -> str:
        return f"<function of {', '.join(self.arguments)}>"


#: Functions by the names that expressions have for them.
Functions = Mapping[str, Union[Function, Callable[..., Any]]]


def known(functions: Optional[Functions]) -> Dict[str, Function]:
    """Functions with all that is known of them."""
    return {name: law if isinstance(law, Function) else Function(law) for name, law in (functions or {}).items()}


def described(functions: Mapping[str, Function]) -> List[Tuple[Any, ...]]:
    """Functions as the extension module takes them."""
    return [
        (name, f.arguments, f.law, list(f.slopes.items()), f.unit, None if f.switches is None else list(f.switches.items()))
        for name, f in functions.items()
    ]


def fingerprint(functions: Mapping[str, Function]) -> str:
    """Tells functions by their sources; values that these refer to do not count."""
    import hashlib

    texts = [
        [name, *(_source(law) for law in (f.law, *f.slopes.values())), str(list(f.slopes)), str(f.switches), str(f.unit)]
        for name, f in functions.items()
    ]
    return hashlib.sha256(repr(texts).encode()).hexdigest() if texts else ""


def _source(law: Callable[..., Any]) -> str:
    import inspect

    try:
        return inspect.getsource(law)
    except (OSError, TypeError):
        return getattr(law, "__qualname__", repr(type(law)))


def _arguments(law: Callable[..., Any]) -> List[str]:
    import inspect

    try:
        parameters = inspect.signature(law).parameters.values()
    except (TypeError, ValueError):
        raise TypeError(f"no arguments of {law!r} can be seen; name them, `grashof.Function(law, arguments=[\"x\"])`") from None
    # what has a value already keeps it
    wanted = [p for p in parameters if p.default is p.empty and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]
    named = [p.name for p in wanted if p.kind != p.KEYWORD_ONLY]
    if len(named) < len(wanted):
        raise TypeError(f"{law!r} has arguments that are given by name alone; those of a function are given by their places")
    if not named:
        raise TypeError(f"no arguments of {law!r} can be seen; name them, `grashof.Function(law, arguments=[\"x\"])`")
    return named


def _ordered(switches: Mapping[str, str], arguments: List[str]) -> Dict[str, str]:
    """The switches in the order of the last arguments, which say on which side they are."""
    tail = arguments[len(arguments) - len(switches) :]
    if set(tail) != set(switches):
        wanted = ", ".join(switches)
        raise TypeError(f"the switches {wanted} are the last arguments of the function, which has {', '.join(arguments)}")
    return {name: switches[name] for name in tail}
