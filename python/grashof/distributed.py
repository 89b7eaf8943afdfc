"""Sweeps on the machines of a Ray cluster.

Runs go out in parts that take about a second. A part is a task without a memory of its own, which Ray computes again wherever a worker or
a machine is lost; when it is finished it is written to the directory of the sweep, and nothing of it is kept in memory.
"""

from __future__ import annotations

import hashlib
import json
import sys
import time
from typing import Any, Callable, Dict, List, Optional, Tuple

from . import _grashof, _text
from .cluster import Task, compute, connected
from .errors import Interrupted
from .functions import Function
from .functions import fingerprint as by_source
from .gathered import SweepTable
from .parts import Parts

__all__ = ["sweep"]

#: Time that the runs of a part take together, s.
WORK = 1.5
#: Parts that are out, by processor: one that is computed, and one that waits.
AHEAD = 2
#: How much longer a part may be than those before.
GROWTH = 4
#: How often processors are counted, and how long finished parts are waited for at a time, s.
LOOK = 2.0

Progress = Callable[[int, int], object]


def sweep(
    core: _grashof.Model,
    functions: Dict[str, Function],
    study: str,
    over: List[Tuple[str, str]],
    samples: Optional[Tuple[int, int]],
    *,
    address: Optional[str],
    into: _text.Path,
    progress: Optional[Progress],
) -> SweepTable:
    """Computes a sweep on a cluster into a directory, or what is missing of it there."""
    prepared = core.prepare(study, over, samples, 1)
    about: Dict[str, Any] = {
        "grashof": _grashof.version,
        "study": study,
        "parameters": prepared.parameters,
        # the values of the sweep are among its content
        "model": hashlib.sha256(prepared.content().encode()).hexdigest(),
        "values": hashlib.sha256(json.dumps(over).encode()).hexdigest(),
        "samples and seed": list(samples) if samples else None,
        **({"functions": by_source(functions)} if functions else {}),
    }
    fingerprint = hashlib.sha256(json.dumps(about).encode()).hexdigest()
    task = Task(fingerprint, _grashof.version, core.pack(), functions, study, tuple(over), samples)
    name = f"{study}-over-{'+'.join(prepared.parameters)}" if over else study
    parts = Parts(into, name, prepared.count, about)
    try:
        if parts.missing():
            with connected(address) as ray:
                _Driver(ray, task, parts, _shown(progress)).run()
        elif progress is not None:
            progress(parts.done, parts.count)
        parts.gather(prepared)
    except Interrupted:
        raise
    except KeyboardInterrupt:
        raise interrupted(parts) from None
    finally:
        parts.close()
    return SweepTable(str(parts.gathered), study, prepared)


class Pace:
    """How many runs a part has: by the time that runs have taken."""

    def __init__(self) -> None:
        self._each: Optional[float] = None
        self._longest = 1

    def size(self, left: int, processors: int) -> int:
        """Runs of the next part, where so many are left to be sent."""
        if self._each is None:
            return 1
        wanted = min(WORK / max(self._each, 1e-9), GROWTH * self._longest)
        # the last parts are shorter, so that all processors end together
        return max(1, min(int(wanted), left // (AHEAD * processors)))

    def learn(self, runs: int, seconds: float) -> None:
        """A part has taken so long."""
        each = seconds / runs
        self._each = each if self._each is None else (self._each + each) / 2
        self._longest = max(self._longest, runs)


class _Driver:
    """Sends parts out, and keeps them when they come back."""

    def __init__(self, ray: Any, task: Task, parts: Parts, progress: Progress) -> None:
        self._ray = ray
        self._parts = parts
        self._progress = progress
        self._task = ray.put(task)
        # a part that is lost with its worker or its machine is computed again, without end
        self._compute = ray.remote(num_cpus=1, max_retries=-1)(compute)
        self._pace = Pace()
        self._waiting = parts.missing()[::-1]
        self._out: Dict[Any, Tuple[int, int]] = {}
        self._counted = (float("-inf"), 1)

    def run(self) -> None:
        """Computes all that is missing."""
        self._progress(self._parts.done, self._parts.count)
        try:
            while self._waiting or self._out:
                self._send()
                finished, _ = self._ray.wait(list(self._out), timeout=LOOK)
                for reference in finished:
                    self._keep(reference)
        except KeyboardInterrupt:
            self._cancel()
            raise interrupted(self._parts) from None
        except BaseException:
            self._cancel()
            raise

    def _processors(self) -> int:
        """Processors of the cluster, which may grow and shrink."""
        now = time.monotonic()
        if now - self._counted[0] > LOOK:
            self._counted = (now, max(1, int(self._ray.cluster_resources().get("CPU", 1))))
        return self._counted[1]

    def _send(self) -> None:
        """Sends parts as long as few are out."""
        processors = self._processors()
        while self._waiting and len(self._out) < AHEAD * processors:
            first, end = self._waiting.pop()
            left = end - first + sum(end - first for first, end in self._waiting)
            cut = min(end, first + self._pace.size(left, processors))
            if cut < end:
                self._waiting.append((cut, end))
            self._out[self._compute.remote(self._task, first, cut)] = (first, cut)

    def _keep(self, reference: Any) -> None:
        """Keeps what a part has come to; sends it once more where that was lost."""
        first, end = self._out.pop(reference)
        errors = self._ray.exceptions
        try:
            table, seconds = self._ray.get(reference)
        except errors.RayTaskError as failed:
            raise failed.cause from None
        except (errors.ObjectLostError, errors.WorkerCrashedError, errors.NodeDiedError):
            self._waiting.append((first, end))
            return
        self._parts.add(first, end, table)
        self._pace.learn(end - first, seconds)
        self._progress(self._parts.done, self._parts.count)

    def _cancel(self) -> None:
        for reference in self._out:
            self._ray.cancel(reference)
        self._out.clear()


def interrupted(parts: Parts) -> Interrupted:
    """What tells that a sweep was ended, and that nothing of it is lost."""
    kept = f"{parts.done} of {parts.count} runs are kept in `{parts.directory}`"
    help = "the same call goes on from them"
    return Interrupted(f"the sweep was interrupted: {kept}; {help}", code="interrupted", help=help)


def _shown(progress: Optional[Progress]) -> Progress:
    """Who is told of the progress: a function, or a line of the terminal."""
    if progress is not None:
        return progress
    if not sys.stderr.isatty():
        return lambda done, count: None
    return _line


def _line(done: int, count: int) -> None:
    print(f"\r{done} of {count} runs", end="\n" if done == count else "", file=sys.stderr, flush=True)
