"""The directory of a sweep that is computed in parts: what is finished stays there, whatever happens to who computes it.

``sweep.json`` says of which sweep the directory is; ``parts/<first>-<end>.parquet`` hold finished runs, which the gathered file replaces.
"""

from __future__ import annotations

import json
import os
import pathlib
import re
from typing import Any, Dict, Iterator, List, Optional, Tuple

from . import _grashof, _text
from .errors import Refused

__all__ = ["Parts"]

_PART = re.compile(r"(\d+)-(\d+)\.parquet")


def write_whole(path: pathlib.Path, content: bytes) -> None:
    """Writes a file that is there with all its content or not at all."""
    unfinished = path.with_name(f".{path.name}.new")
    with open(unfinished, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    os.replace(unfinished, path)


class Parts:
    """The finished parts of a sweep of ``count`` runs in a directory, of which ``about`` says all that decides its results.

    Raises :class:`Refused` if the directory holds another sweep, or somebody else writes there.
    """

    def __init__(self, into: _text.Path, name: str, count: int, about: Dict[str, Any]) -> None:
        self.directory = pathlib.Path(os.fspath(into))
        self.count = count
        #: The table of all runs, when they are there.
        self.gathered = self.directory / f"{name}.parquet"
        self._parts = self.directory / "parts"
        self._parts.mkdir(parents=True, exist_ok=True)
        self._lock = _locked(self._parts / ".lock", self.directory)
        try:
            self._claim({**about, "runs": count})
            self._done: List[Tuple[int, int]] = self._whole() if self.is_gathered() else self._found()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Lets others write to the directory."""
        if self._lock is not None:
            self._lock.close()

    def _claim(self, about: Dict[str, Any]) -> None:
        """Makes the directory that of this sweep."""
        path = self.directory / "sweep.json"
        if not path.exists():
            if self.gathered.exists():
                raise _refused(f"`{self.gathered}` is there already, and nothing says of which sweep it is")
            write_whole(path, json.dumps(about, indent=2).encode())
            return
        try:
            known = json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            raise _refused(f"`{path}` cannot be read") from None
        if known != about:
            keys = known.keys() | about.keys() if isinstance(known, dict) else ()
            others = sorted(key for key in keys if known.get(key) != about.get(key))
            # a model with other values is not the same
            others = [key for key in others if key != "model"] or others
            raise _refused(f"`{self.directory}` holds another sweep, of another {' and '.join(others) or 'kind'}")

    def is_gathered(self) -> bool:
        """Whether the table of all runs is there."""
        return self.gathered.exists() and _rows(self.gathered) == self.count

    def _whole(self) -> List[Tuple[int, int]]:
        self._remove_parts()
        return [(0, self.count)]

    def _found(self) -> List[Tuple[int, int]]:
        """Finished parts in their order; broken ones go."""
        found: List[Tuple[int, int]] = []
        for first, end, path in sorted(self._named()):
            if end <= self.count and (not found or found[-1][1] <= first) and _rows(path) == end - first:
                found.append((first, end))
            else:
                path.unlink()
        return found

    def _named(self) -> Iterator[Tuple[int, int, pathlib.Path]]:
        for path in self._parts.iterdir():
            named = _PART.fullmatch(path.name)
            if named:
                yield int(named[1]), int(named[2]), path

    def _path(self, first: int, end: int) -> pathlib.Path:
        return self._parts / f"{first}-{end}.parquet"

    @property
    def done(self) -> int:
        """Number of finished runs."""
        return sum(end - first for first, end in self._done)

    def missing(self) -> List[Tuple[int, int]]:
        """Runs that are not finished: from one on to another, which is the first that is."""
        ends = [0, *(end for _, end in sorted(self._done))]
        begins = [*(first for first, _ in sorted(self._done)), self.count]
        return [(first, end) for first, end in zip(ends, begins) if first < end]

    def add(self, first: int, end: int, table: bytes) -> None:
        """Keeps a finished part, the bytes of its table."""
        write_whole(self._path(first, end), table)
        self._done.append((first, end))

    def gather(self, sweep: _grashof.Sweep) -> None:
        """Makes the table of all runs of those of the parts, which go."""
        if self.is_gathered():
            return
        unfinished = self.gathered.with_name(f".{self.gathered.name}.new")
        sweep.gather([str(self._path(*part)) for part in sorted(self._done)], str(unfinished))
        os.replace(unfinished, self.gathered)
        self._remove_parts()

    def _remove_parts(self) -> None:
        for *_, path in list(self._named()):
            path.unlink()


def _rows(path: pathlib.Path) -> Optional[int]:
    """Number of rows of a table; none if it is broken."""
    try:
        return _grashof.Table(str(path)).rows
    except Refused:
        return None


def _locked(path: pathlib.Path, directory: pathlib.Path) -> Any:
    """A file that nobody else has locked; none where the system has no such locks."""
    try:
        import fcntl
    except ImportError:
        return None
    file = open(path, "wb")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise _refused(f"a sweep is being computed into `{directory}`") from None
    except OSError:
        # a file system without locks
        pass
    return file


def _refused(message: str) -> Refused:
    help = "name another directory, or remove this one"
    return Refused(f"{message}; {help}", code="refused", help=help)
