"""What goes wrong: exceptions with a code to search for, the place in the model file, and a remedy."""

from __future__ import annotations

from typing import List, NamedTuple, Sequence

__all__ = ["Error", "Fault", "Interrupted", "ModelError", "Refused", "StudyError", "UnknownName"]


class Fault(NamedTuple):
    """One finding in a model file."""

    #: A stable name in kebab-case: ``unknown-key``, ``wrong-dimension``.
    code: str
    #: ``error`` or ``warning``.
    severity: str
    #: What was found.
    message: str
    #: What was expected; empty if the message says it.
    expected: str
    #: One remedy; may be empty.
    help: str
    #: Path of keys in the file: ``joints.O.revolute[1]``; empty if there is none.
    place: str
    #: Name of the file; of what is given in a call the name of its argument, as ``values`` or ``over``; ``<text>`` of a model in code.
    file: str
    #: Line, counted from 1; 0 if there is no place.
    line: int
    #: Column in characters, counted from 1; 0 if there is no place.
    column: int
    #: All of it with the line of the file, as the program prints it.
    text: str

    def __str__(self) -> str:
        return self.text.rstrip()


class Error(Exception):
    """What all errors of Grashof are."""

    def __init__(self, message: str, *, code: str = "", place: str = "", help: str = "", faults: Sequence[Fault] = ()) -> None:
        super().__init__(message)
        #: The kind of the first fault, a word to search for.
        self.code: str = code
        #: Path of keys of the first fault in the file; empty if there is none.
        self.place: str = place
        #: What to do about it; may be empty.
        self.help: str = help
        #: All faults, each with its place.
        self.faults: List[Fault] = list(faults)

    def __str__(self) -> str:
        # of a KeyError the text would be quoted
        return Exception.__str__(self)


class ModelError(Error):
    """A model file cannot be read, or it, or what is asked of it, is wrong."""


class StudyError(Error):
    """A study has no result."""


class UnknownName(Error, KeyError):
    """There is nothing of a name; the help says which names there are."""

    __str__ = Error.__str__


class Refused(Error):
    """What is asked for cannot be given."""


class Interrupted(Error, KeyboardInterrupt):
    """A run was ended by Ctrl-C."""
