"""Writes docs/python-reference.md from the sources of the package: `python python/reference.py`.

Signatures and types are those of the annotations, texts those of the docstrings and of the comments `#:` before attributes.
With `--check` nothing is written; the exit code is 1 where the page is not what the sources give.
"""

from __future__ import annotations

import ast
import pathlib
import re
import sys
import textwrap
from typing import Dict, Iterator, List, NamedTuple, Optional, Tuple, Union

HERE = pathlib.Path(__file__).resolve().parent
PACKAGE = HERE / "grashof"
PAGE = HERE.parent / "docs" / "python-reference.md"

#: The public names by what they are for, in the order of the page.
SECTIONS: Dict[str, List[str]] = {
    "Models and studies": ["load", "parse", "LoadedModel", "Study", "Model", "Function"],
    "Sweeps with drawn values": ["normal", "uniform", "Distribution", "Sensitivity", "Index"],
    "Sweeps on clusters": ["SweepTable"],
    "Results of a study": ["Results", "Runs", "Page", "Animation"],
    "What results hold": ["Extremes", "Extreme", "Statistics", "Part", "Finding", "Event", "Checked", "Solution"],
    "Linear systems": ["Linear"],
    "Comparisons of integrators": ["Compared", "ComparedRun"],
    "Equations of motion": ["Dynamics", "Pose"],
    "Motions that are stepped": ["Stepper", "State"],
    "What goes wrong": ["Error", "ModelError", "StudyError", "UnknownName", "Refused", "Interrupted", "Fault"],
}

HEAD = """# Reference of the Python package

<!-- Written by python/reference.py from the sources of the package; changes here are lost. -->

All public names of `grashof`. [Grashof from Python](python.md) begins at the beginning. Numbers are SI and radians. `Array` is a NumPy array of `float64`; shapes stand in parentheses, and `...` in them are any axes. `grashof.__version__` is the version of the library.
"""

#: Longest call on one line.
WIDTH = 120
#: Names of types that users see under a shorter one.
TYPES = re.compile(r"\b(_text|_grashof)\.")
Function = Union[ast.FunctionDef, ast.AsyncFunctionDef]
Public = Union[ast.ClassDef, ast.FunctionDef]


class Attribute(NamedTuple):
    """What an object holds: a property, a field or an attribute."""

    name: str
    type: str
    text: str


class Module:
    """A module of the package: its tree and its comments."""

    def __init__(self, path: pathlib.Path) -> None:
        source = path.read_text(encoding="utf-8")
        self.tree = ast.parse(source)
        self.lines = source.splitlines()

    def comment(self, line: int) -> str:
        """The comment `#:` that ends before a line, counted from 1."""
        found: List[str] = []
        for text in map(str.strip, reversed(self.lines[: line - 1])):
            if not text.startswith("#:"):
                break
            found.insert(0, text[2:].strip())
        return " ".join(found)


def public() -> Dict[str, Tuple[Module, Public]]:
    """Where each public name is defined."""
    modules = [Module(path) for path in sorted(PACKAGE.glob("*.py"))]
    defined = {
        node.name: (module, node)
        for module in modules
        for node in module.tree.body
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_")
    }
    return {name: defined[name] for name in exported()}


def exported() -> List[str]:
    """The names that the package gives."""
    for node in Module(PACKAGE / "__init__.py").tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id == "__all__":
            return list(ast.literal_eval(node.value))
    raise SystemExit("the package has no `__all__`")


def aliases() -> Iterator[Attribute]:
    """Types that arguments have."""
    module = Module(PACKAGE / "_text.py")
    for node in module.tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            yield Attribute(node.targets[0].id, "", module.comment(node.lineno))


def decorators(function: Function) -> List[str]:
    return [ast.unparse(each) for each in function.decorator_list]


def annotation(node: Optional[ast.expr]) -> str:
    """A type as users write it."""
    return TYPES.sub("", ast.unparse(node).replace("'", "")).replace("NDArray[np.float64]", "Array") if node else ""


def signature(name: str, function: Function, method: bool) -> str:
    """A call with the types of its arguments and of what it gives."""
    # a copy without `self`, and with the types as users write them
    copy = ast.parse(TYPES.sub("", ast.unparse(function))).body[0]
    assert isinstance(copy, ast.FunctionDef)
    first = copy.args.posonlyargs or copy.args.args
    if method:
        del first[0]
    returns = annotation(copy.returns)
    # arguments with a default have a type, and types have no `=`
    arguments = re.sub("=", " = ", ast.unparse(copy.args))
    call = f"{name}({arguments})" + (f" -> {returns}" if returns and function.name != "__init__" else "")
    return call if len(call) <= WIDTH else call.replace(arguments, "\n" + "".join(f"    {each},\n" for each in parted(arguments)))


def parted(arguments: str) -> List[str]:
    """Arguments one by one: at the commas outside of brackets."""
    found = [""]
    for part in arguments.split(", "):
        inside = found[-1].count("[") > found[-1].count("]")
        if inside:
            found[-1] += f", {part}"
        elif found == [""]:
            found = [part]
        else:
            found.append(part)
    return found


def attributes(module: Module, owner: ast.ClassDef) -> Iterator[Attribute]:
    """Fields, attributes that are set at the beginning, and properties."""
    for node in owner.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and not node.target.id.startswith("_"):
            yield Attribute(node.target.id, annotation(node.annotation), module.comment(node.lineno))
        elif isinstance(node, ast.FunctionDef) and node.name == "__init__":
            for each in ast.walk(node):
                if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Attribute) and not each.target.attr.startswith("_"):
                    yield Attribute(each.target.attr, annotation(each.annotation), module.comment(each.lineno))
        elif isinstance(node, ast.FunctionDef) and is_property(node) and not node.name.startswith("_"):
            yield Attribute(node.name, annotation(node.returns), ast.get_docstring(node) or "")


def is_property(function: Function) -> bool:
    return any(name in ("property", "cached_property") for name in decorators(function))


def methods(owner: ast.ClassDef) -> Iterator[Tuple[str, List[str], str]]:
    """Heading, calls and text of each method; of the special ones those with a text."""
    calls: Dict[str, List[str]] = {}
    for node in owner.body:
        if not isinstance(node, ast.FunctionDef) or is_property(node):
            continue
        text = ast.get_docstring(node) or ""
        overload = "overload" in decorators(node)
        if node.name.startswith("_") and not (node.name.startswith("__") and (text or overload)):
            continue
        heading, name = f"{owner.name}.{node.name}", owner.name if node.name == "__init__" else node.name
        known = calls.setdefault(heading, [])
        if overload or not known:
            known.append(signature(name, node, method=True))
        if not overload:
            yield heading, known, text


def anchor(heading: str) -> str:
    """The name of a heading in links."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def prose(of: str, text: str, names: Dict[str, str]) -> str:
    """A docstring as Markdown: paragraphs on one line each, examples as code, references as links."""
    if not text:
        raise SystemExit(f"`{of}` has no docstring")
    parts = []
    for part in re.split(r"\n\s*\n", textwrap.dedent(text).strip()):
        lines = part.splitlines()
        if lines and lines[0].startswith(">>>"):
            parts.append("```python\n" + "\n".join(re.sub(r"^(>>>|\.\.\.) ?", "", line) for line in lines) + "\n```")
        elif lines and lines[0].startswith("    "):
            parts.append("```text\n" + textwrap.dedent(part) + "\n```")
        else:
            parts.append(inline(" ".join(line.strip() for line in lines), names))
    return "\n\n".join(parts)


def inline(text: str, names: Dict[str, str]) -> str:
    """Names as code or links."""

    def linked(match: re.Match[str]) -> str:
        name = match[1]
        if name not in names:
            raise SystemExit(f"a docstring refers to `{name}`, which is not public")
        return f"[`{name}`](#{names[name]})"

    text = re.sub(r":\w+:`([^`]+)`", linked, text)
    return re.sub(r"``([^`]+)``", r"`\1`", re.sub(r"::$", ":", text))


def table(rows: List[Attribute], names: Dict[str, str]) -> str:
    """What an object holds, a row each."""

    def cell(text: str) -> str:
        return text.replace("|", "\\|")

    lines = [f"| `{row.name}` | `{cell(row.type)}` | {cell(' '.join(prose(row.name, row.text, names).split()))} |" for row in rows]
    return "\n".join(["| name | type | |", "|---|---|---|", *lines])


def links(found: Dict[str, Tuple[Module, Public]]) -> Dict[str, str]:
    """Each name that docstrings may refer to, with the heading at which it stands."""
    names = {name: anchor(name) for name in found}
    for name, (module, node) in found.items():
        if isinstance(node, ast.ClassDef):
            names.update({f"{name}.{each.name}": anchor(name) for each in attributes(module, node)})
            names.update({heading: anchor(heading) for heading, _, _ in methods(node)})
    return names


def entry(name: str, module: Module, node: Public, names: Dict[str, str]) -> Iterator[str]:
    """All that is to be said of a public name."""
    yield f"### {name}"
    if isinstance(node, ast.FunctionDef):
        yield f"```python\n{signature(name, node, method=False)}\n```"
    elif node.bases:
        yield "Bases: " + ", ".join(f"`{annotation(base)}`" for base in node.bases) + "."
    yield prose(name, ast.get_docstring(node) or "", names)
    if isinstance(node, ast.ClassDef):
        if rows := list(attributes(module, node)):
            yield table(rows, names)
        for heading, calls, text in methods(node):
            yield f"#### `{heading}`"
            yield "```python\n" + "\n".join(calls) + "\n```"
            yield prose(heading, text, names)


def contents(names: Dict[str, str]) -> str:
    """The sections with their names, as links."""
    lines = []
    for title, of in SECTIONS.items():
        listed = ", ".join(f"[`{name}`](#{names[name]})" for name in of)
        lines.append(f"- [{title}](#{anchor(title)}): {listed}")
    return "\n".join(lines)


def page() -> str:
    """The text of the page."""
    found = public()
    listed = [name for names in SECTIONS.values() for name in names]
    if sorted(listed) != sorted(found):
        raise SystemExit(f"SECTIONS and `__all__` differ by {sorted(set(listed) ^ set(found))}")
    names = links(found)
    parts = [HEAD.rstrip(), contents(names), "## Types of arguments"]
    parts.append("\n".join(f"- `{each.name}`: {inline(each.text, names)}" for each in aliases()))
    for title, of in SECTIONS.items():
        parts.append(f"## {title}")
        for name in of:
            parts.extend(part for part in entry(name, *found[name], names) if part)
    return "\n\n".join(parts) + "\n"


def main() -> int:
    text = page()
    if "--check" in sys.argv[1:]:
        current = PAGE.exists() and PAGE.read_text(encoding="utf-8") == text
        if not current:
            print("docs/python-reference.md is not what the sources give: run `python python/reference.py`", file=sys.stderr)
        return 0 if current else 1
    PAGE.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
