#!/usr/bin/env python3
"""Measures all codes on all problems and writes docs/comparison.md; called by `run`."""

import argparse
import importlib
import json
import math
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "codes")]

import problems  # noqa: E402

DOCUMENT = HERE.parent.parent / "docs"
CODES = ["Grashof", "MuJoCo", "Exudyn", "Drake", "Simbody", "Pinocchio"]
TARGETS = [1e-4, 1e-6, 1e-8]
SIZES = [10, 100, 1000]
# runs that are shorter are repeated, s
SHORT = 0.3


def program_families(code, problem):
    """Settings of the codes that are programs of their own, from coarse to fine."""
    if code == "Grashof":
        return importlib.import_module("grashof_code").families(problem)
    if code == "Simbody":
        return {name: [f"{name}:{10.0**-k:.0e}" for k in range(2, 13)] for name in ("merson", "feldberg", "cpodes")}
    gains = [0, 10, 100, 1000, 10000] if problem.loops else [0]
    return {f"gains of {gain} 1/s" if problem.loops else "DOP853": [f"{10.0**-k:.0e}:{gain}" for k in range(3, 13)] for gain in gains}


def program(code, problem, work, settings):
    """Runs a program on settings, one call for all; what it prints, by line."""
    with tempfile.NamedTemporaryFile("w", suffix=".yaml" if code == "Grashof" else ".txt") as file:
        file.write(importlib.import_module("grashof_code").model(problem) if code == "Grashof" else problems.as_lines(problem))
        file.flush()
        done = subprocess.run([work / code.lower(), file.name, *settings], capture_output=True, text=True, timeout=600)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def error_of(problem, measured):
    if len(measured) != len(problem.reference) or not all(math.isfinite(x) for x in measured):
        return math.inf
    return max(abs(a - b) for a, b in zip(measured, problem.reference))


def family(code, problem, settings, work, limit):
    """Seconds and error of each setting until one takes too long."""
    out = []
    module = None if code in ("Grashof", "Simbody", "Pinocchio") else importlib.import_module(f"{code.lower()}_code")
    for setting in settings:
        best = error = math.inf
        for _ in range(3):
            try:
                if module:
                    seconds, measured = module.run(problem, setting)
                else:
                    [line] = program(code, problem, work, [setting])
                    seconds, measured = line["seconds"], line["measured"]
            except Exception as why:
                print(f"   {code}, {problem.name}, {setting}: {str(why).splitlines()[0][:120] if str(why) else type(why).__name__}", file=sys.stderr)
                seconds, measured = math.nan, []
            best, error = min(best, seconds), error_of(problem, measured)
            if not seconds < SHORT:
                break
        out.append((best, error))
        if not best < limit:
            break
    return out


def one(arguments):
    """Everything of one code on one problem, in a process of its own."""
    problem = next(p for p in problems.accuracy() if p.name == arguments.one[1])
    code = arguments.one[0]
    own = program_families(code, problem) if code in ("Grashof", "Simbody", "Pinocchio") else importlib.import_module(
        f"{code.lower()}_code").families(problem)
    found = {name: family(code, problem, settings, arguments.work, arguments.limit) for name, settings in own.items()}
    pathlib.Path(arguments.one[2]).write_text(json.dumps(found))


def cost(arguments):
    """Set-up, evaluation and step of one code on one problem."""
    code, kind, n, path = arguments.cost
    n = int(n)
    problem = problems.chain(n) if kind == "chain" else problems.four_bars(n, end=0.01)
    if code in ("Simbody", "Pinocchio"):
        [line] = program(code, problem, arguments.work, ["cost"])
        evaluation, *step = line["measured"]
        found = [line["seconds"], step[0] if step else None, evaluation]
    elif code == "Grashof":
        explicit = program(code, problem, arguments.work, ["cost:dop853:1e-6"] * 3)
        # the first steps, of order one, are those of a start
        under_way = problem if kind == "chain" else problems.four_bars(n, end=0.3)
        implicit = program(code, under_way, arguments.work, ["cost:bdf:1e-4"] * 3)
        found = [min(line["seconds"] for line in explicit), min(line["measured"][1] for line in implicit),
                 min(line["measured"][0] for line in explicit)]
    else:
        found = list(importlib.import_module(f"{code.lower()}_code").cost(problem))
    pathlib.Path(path).write_text(json.dumps(found))


def apart(words, arguments, seconds):
    """What a process of its own writes; none if it fails or takes too long."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        call = [sys.executable, __file__, "--work", arguments.work, "--limit", str(arguments.limit), *words, file.name]
        try:
            # MuJoCo writes its warnings where it is run
            subprocess.run(call, stdout=subprocess.DEVNULL, timeout=seconds, check=False, cwd=arguments.work)
            return json.loads(pathlib.Path(file.name).read_text() or "null")
        except (subprocess.TimeoutExpired, json.JSONDecodeError):
            return None


def reached(found, target):
    """The least time from which a family stays below an error, over all families; none if none does."""
    best = None
    for name, runs in (found or {}).items():
        within = []
        for seconds, error in reversed(runs):
            # a run that was ended for its time is no failure of its setting, but no result either
            if not within and not error < math.inf:
                continue
            if error > target:
                break
            within.append(seconds)
        if within and (best is None or min(within) < best[0]):
            best = (min(within), name)
    return best


def nearest(found):
    """The smallest error, and its time."""
    runs = [(error, seconds) for runs in (found or {}).values() for seconds, error in runs if error < math.inf]
    return min(runs, default=None)


def duration(seconds):
    if seconds is None:
        return "-"
    for size, unit in ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.0f} ns"


def accuracy_table(problem, found):
    """Rows of a problem: times at the targets and how many times that of Grashof."""
    own = {target: reached(found["Grashof"], target) for target in TARGETS}
    lines = [f"### {problem.name}", "", f"{problem.about}.", "", "| code | " + " | ".join(f"error {t:.0e}" for t in TARGETS) + " | nearest | by |",
             "|---|" + "---:|" * len(TARGETS) + "---:|---|"]
    for code in (code for code in CODES if code in found):
        cells, names = [], []
        for target in TARGETS:
            best = reached(found[code], target)
            if best is None:
                cells.append("not reached")
                continue
            ratio = "" if code == "Grashof" or not own[target] else f" ({best[0] / own[target][0]:.3g} ×)"
            cells.append(duration(best[0]) + ratio)
            names.append(best[1])
        least = nearest(found[code])
        near = f"{least[0]:.1e} in {duration(least[1])}" if least else "fails"
        lines.append(f"| {code} | {' | '.join(cells)} | {near} | {', '.join(dict.fromkeys(names))} |")
    return lines + [""]


def cost_tables(costs):
    lines = []
    for kind, index, title in (("chain", 2, "A chain of N thin rods: an evaluation"), ("four-bars", 2, "N four-bars in a row: an evaluation"),
                               ("four-bars", 1, "N four-bars in a row: a step"), ("four-bars", 0, "N four-bars in a row: set-up")):
        lines += [f"### {title}", "", "| code | " + " | ".join(f"N = {n}" for n in SIZES) + " |", "|---|" + "---:|" * len(SIZES)]
        for code in CODES:
            cells = [costs.get((code, kind, n)) for n in SIZES]
            shown = ["fails or over the limit" if cell is None else duration(cell[index]) for cell in cells]
            if any(cell is not None and cell[index] is not None for cell in cells):
                lines.append(f"| {code} | {' | '.join(shown)} |")
        lines.append("")
    return lines


def figure(results, path):
    """Work-precision diagrams: all runs of the best family of each code."""
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    matplotlib.rcParams.update({"svg.hashsalt": "grashof", "font.size": 9, "svg.fonttype": "path"})
    marks = dict(zip(CODES, "o s ^ D v P".split()))
    colours = dict(zip(CODES, ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]))
    rows = math.ceil(len(results) / 2)
    fig, axes = plt.subplots(rows, 2, figsize=(9, 2.9 * rows), layout="constrained", squeeze=False)
    for ax, (problem, found) in zip(axes.flat, results):
        for code in (code for code in CODES if code in found):
            points = [(s, e) for runs in (found[code] or {}).values() for s, e in runs if 1e-13 < e < 10]
            # the lower left border: no other run of the code is faster and nearer
            border = [p for p in sorted(points) if not any(s < p[0] and e <= p[1] for s, e in points)]
            if border:
                ax.loglog([e for _, e in border], [s for s, _ in border], marker=marks[code], markersize=4, linewidth=1.2,
                          color=colours[code], label=code)
        ax.set_title(problem.name, fontsize=10)
        ax.grid(True, which="major", color="#e0e0e0", linewidth=0.6)
        ax.set_xlabel("error at the end")
        ax.set_ylabel("processor time in s")
        ax.invert_xaxis()
    for ax in list(axes.flat)[len(results):]:
        ax.axis("off")
    handles = {}
    for ax in axes.flat:
        handles.update({label: handle for handle, label in zip(*ax.get_legend_handles_labels())})
    fig.legend([handles[c] for c in CODES if c in handles], [c for c in CODES if c in handles], loc="outside upper center", ncols=6, frameon=False)
    fig.savefig(path, metadata={"Date": None})


def versions(work):
    """Versions of the codes."""
    import importlib.metadata as about
    package = {"MuJoCo": "mujoco", "Exudyn": "exudyn", "Drake": "drake", "Pinocchio": "pin"}
    found = {code: about.version(name) for code, name in package.items()}
    simbody = subprocess.run(["dpkg-query", "-W", "-f=${Version}", "libsimbody-dev"], capture_output=True, text=True, check=False).stdout
    return {**found, "Simbody": simbody.split("+")[0] or "installed"}


def document(results, costs, arguments):
    tried = {code: " ".join(importlib.import_module(f"{code.lower()}_code").__doc__.split()) for code in ("MuJoCo", "Exudyn", "Drake")}
    known = versions(arguments.work)
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    lines = (HERE / "head.md").read_text().rstrip("\n").split("\n")
    lines += ["", "## The codes", "", f"All on one core of: {cpu}; Linux {platform.machine()}.", "",
              "- **Grashof**, this version: `dop853` from 1e-3 to 1e-12, the stiff governor by `bdf` and `radau5`."]
    lines += [f"- **{code}** {known[code]}. {tried[code]}" for code in ("MuJoCo", "Exudyn", "Drake")]
    lines += [f"- **Simbody** {known['Simbody']}. Runge-Kutta-Merson, Runge-Kutta-Fehlberg and CPodes (BDF with Newton's method), accuracies from 1e-2 to "
              "1e-12, projected at every step; loops of the plane by two points in planes, those of space by a ball and two constant angles.",
              f"- **Pinocchio** {known['Pinocchio']} is no simulator: `drivers/pinocchio.cpp` puts its constraint dynamics (proximal solver, mu = 1e-9) under "
              "DOP853 and tries Baumgarte's gains from 0 to 1e4 1/s on each problem. It is a floor for general evaluation.",
              "", "## Time to an error", "", "![Processor time over the error of all codes](comparison.svg)", ""]
    for problem, found in results:
        lines += accuracy_table(problem, found)
    lines += ["## Cost over size", "",
              "The chain has no loops, the four-bars have one each. A step is that of the code's usual scheme: of Grashof `bdf` with about three evaluations, the mean over 0.3 s, "
              "of MuJoCo Euler with one, of Exudyn generalized alpha, of Drake a discrete one, of Simbody Merson with 5 evaluations and a projection.", "",
              *cost_tables(costs)]
    (DOCUMENT / "comparison.md").write_text("\n".join(lines).rstrip("\n") + "\n")
    figure(results, DOCUMENT / "comparison.svg")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--work", required=True)
    parser.add_argument("--limit", type=float, default=4.0)
    parser.add_argument("--problem", action="append", default=[])
    parser.add_argument("--code", action="append", default=[])
    parser.add_argument("--no-document", action="store_true")
    parser.add_argument("--one", nargs=3, help=argparse.SUPPRESS)
    parser.add_argument("--cost", nargs=4, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    arguments.work = os.path.abspath(arguments.work)
    arguments.work = pathlib.Path(arguments.work) if arguments.one or arguments.cost else arguments.work
    if arguments.one:
        return one(arguments)
    if arguments.cost:
        return cost(arguments)
    codes = [code for code in CODES if not arguments.code or code in arguments.code]
    results = []
    for problem in problems.accuracy():
        if arguments.problem and problem.name not in arguments.problem:
            continue
        found = {}
        for code in codes:
            found[code] = apart(["--one", code, problem.name], arguments, 60 + 40 * arguments.limit)
            shown = [reached(found[code], target) for target in TARGETS]
            print(f"{problem.name:14} {code:10} " + "  ".join(f"{duration(best and best[0]):>10}" for best in shown), flush=True)
        results.append((problem, found))
    if arguments.problem or arguments.code:
        return None
    costs = {}
    for kind in ("chain", "four-bars"):
        for code in codes:
            for n in SIZES:
                costs[code, kind, n] = apart(["--cost", code, kind, str(n)], arguments, 15 * arguments.limit)
                print(f"{kind:10} {n:5} {code:10} {[duration(x) for x in costs[code, kind, n] or []]}", flush=True)
                if costs[code, kind, n] is None:
                    break
    if not arguments.no_document:
        document(results, costs, arguments)
    return None


if __name__ == "__main__":
    main()
