"""Sweeps on a Ray cluster from the command line: what ``grashof sweep --ray`` hands over."""

from __future__ import annotations

import argparse
import sys
from typing import List, Optional, Sequence, Tuple

from . import load, parse
from .errors import Error, Interrupted, Refused, StudyError
from .gathered import SweepTable

#: Exit codes, those of the program.
DONE, INPUT, NUMERICAL, INTERRUPTED = 0, 2, 3, 130


def main(words: Optional[Sequence[str]] = None) -> int:
    """Does what the command line says, and gives the exit code."""
    asked = _arguments().parse_args(words)
    try:
        table = _sweep(asked)
    except (Interrupted, KeyboardInterrupt) as stopped:
        print(str(stopped) or "interrupted", file=sys.stderr)
        return INTERRUPTED
    except Error as error:
        _tell(error)
        return NUMERICAL if isinstance(error, StudyError) else INPUT
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return INPUT
    failed = sum(reason != "" for reason in table.reasons)
    if not asked.quiet:
        print(f"{table.path}: {len(table)} runs" + (f", of which {failed} have no whole result" if failed else ""))
    return NUMERICAL if failed == len(table) else DONE


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m grashof", description="Sweeps on a Ray cluster.")
    commands = parser.add_subparsers(dest="command", required=True)
    sweep = commands.add_parser("sweep", help="run a study for many values of parameters")
    sweep.add_argument("model", help="model file, or - for stdin")
    sweep.add_argument("--ray", required=True, metavar="ADDRESS", help="the cluster, or `local` for one of this machine alone")
    sweep.add_argument("--study", metavar="S", help="may be left out if the model has only one")
    sweep.add_argument("--over", metavar="NAME=VALUES", action="append", default=[])
    sweep.add_argument("--samples", metavar="N", type=int)
    sweep.add_argument("--seed", metavar="N", type=int, default=1)
    sweep.add_argument("--set", metavar="NAME=VALUE", action="append", default=[])
    sweep.add_argument("--variant", metavar="V", action="append", default=[])
    sweep.add_argument("-o", "--output", metavar="DIR", required=True)
    sweep.add_argument("-q", "--quiet", action="store_true")
    return parser


def _sweep(asked: argparse.Namespace) -> SweepTable:
    model = parse(sys.stdin.read()) if asked.model == "-" else load(asked.model)
    model = model.variant(*asked.variant).set(dict(_pairs("--set", asked.set)))
    over = _pairs("--over", asked.over)
    twice = [name for place, (name, _) in enumerate(over) if name in dict(over[:place])]
    if twice:
        help = "leave one of them out"
        raise Refused(f"`{twice[0]}` is swept already; {help}", code="swept-twice", help=help)
    study = _chosen(asked.study, model.studies)
    progress = (lambda done, count: None) if asked.quiet else None
    return model.sweep(
        study,
        dict(over),
        workers="ray",
        address=asked.ray,
        samples=asked.samples,
        seed=asked.seed,
        into=asked.output,
        progress=progress,
    )


def _chosen(named: Optional[str], known: List[str]) -> str:
    """The study that is named, or the only one."""
    if named is None and len(known) != 1:
        help = f"name one of them with `--study`: {', '.join(known)}" if known else "add one"
        raise Refused(f"the model has {len(known)} studies; {help}", code="refused", help=help)
    return named if named is not None else known[0]


def _pairs(flag: str, texts: Sequence[str]) -> List[Tuple[str, str]]:
    """Names with values."""

    def split(text: str) -> Tuple[str, str]:
        name, sign, value = text.partition("=")
        if not sign:
            help = f"write `{flag} NAME=VALUE`"
            raise Refused(f"`{flag} {text}` has no `=`; {help}", code="refused", help=help)
        return name.strip(), value.strip()

    return list(map(split, texts))


def _tell(error: Error) -> None:
    told = "\n".join(str(fault) for fault in error.faults if fault.severity == "error")
    print(told or f"error: {error}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
