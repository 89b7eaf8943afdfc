"""Grashof: mechanisms from a text file to motion, forces, vibrations and pictures.

>>> import grashof
>>> model = grashof.load("crank_rocker.yaml")
>>> results = model.run("one-turn", l3="60 cm")
>>> results["drive.torque"]

All numbers are SI and radians.
"""

from . import _grashof as _core
from .builder import Model
from .compared import Compared, ComparedRun
from .distributions import Distribution, normal, uniform
from .dynamics import Dynamics, Pose
from .errors import Error, Fault, Interrupted, ModelError, Refused, StudyError, UnknownName
from .functions import Function
from .gathered import SweepTable
from .linear import Linear
from .model import LoadedModel, Study, load, parse
from .page import Animation, Page
from .records import Checked, Event, Extreme, Extremes, Finding, Part, Solution, Statistics
from .results import Results, Runs
from .sensitivity import Index, Sensitivity
from .stepper import State, Stepper

#: The version of the library.
__version__: str = _core.version

__all__ = [
    "Animation",
    "Checked",
    "Compared",
    "ComparedRun",
    "Distribution",
    "Dynamics",
    "Error",
    "Event",
    "Extreme",
    "Extremes",
    "Fault",
    "Finding",
    "Function",
    "Index",
    "Interrupted",
    "Linear",
    "LoadedModel",
    "Model",
    "ModelError",
    "Page",
    "Part",
    "Pose",
    "Refused",
    "Results",
    "Runs",
    "Sensitivity",
    "Solution",
    "State",
    "Statistics",
    "Stepper",
    "Study",
    "StudyError",
    "SweepTable",
    "UnknownName",
    "load",
    "normal",
    "parse",
    "uniform",
]
