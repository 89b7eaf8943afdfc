"""Writes the coefficients of DOP853 for `drivers/dop853.h` from those of the scheme in `solvers/src/schemes/dop853/coefficients.rs`."""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE.parent.parent / "solvers/src/schemes/dop853/coefficients.rs"


def rows():
    """Each row of the table by its name: pairs of stage and coefficient."""
    text = TABLE.read_text()
    found = re.findall(r"const (A\d+|B|E5|B3): Row<\d+> = \[(.*?)\];", text, re.S)
    return {name: re.findall(r"\((\d+), (-?[\d_.]+(?:e-?\d+)?)\)", row) for name, row in found}


def header():
    def entries(row):
        return "{" + ", ".join(f"{{{stage}, {x.replace('_', '')}}}" for stage, x in row) + "}"
    table = rows()
    stages = ", ".join(entries(table.get(f"A{s}", [])) for s in range(12))
    one = "using Row = std::vector<std::pair<int, double>>;\n"
    lines = [f"static const std::vector<Row> A = {{{stages}}};"]
    lines += [f"static const Row {name} = {entries(table[name])};" for name in ("B", "E5", "B3")]
    return "#pragma once\n#include <utility>\n#include <vector>\n" + one + "\n".join(lines) + "\n"


if __name__ == "__main__":
    pathlib.Path(sys.argv[1]).write_text(header())
