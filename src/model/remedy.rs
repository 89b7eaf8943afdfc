//! What to do about faults of a kind, where nothing closer to the case is known.

/// The remedy for faults with a code, if all of them have the same.
pub(crate) fn remedy(code: &str) -> Option<&'static str> {
    Some(match code {
        "not-a-model" => {
            "write `grashof: 1` in the first line, then the sections of a model; `grashof new four-bar` writes one to begin with"
        }
        "file-too-large" => "leave out what no study needs, as most points of a measured curve",
        "too-deep" => "write lists and maps as `docs/format.md` shows them",
        "yaml-syntax" => "look at the signs around this place; `docs/format.md`, section `YAML, narrowed`, says what a file may hold",
        "wrong-type" => "write it as expected; `docs/format.md` shows every key with an example",
        "unknown-word" => "take one of those that are expected",
        "expression" => "write what is expected in its place; `docs/format.md`, section `Expressions`, has all operators and functions",
        "cycle" => "give one of them a value that does not need the others",
        "bad-table" => "sort the points by x, and give each x one value",
        "bad-data" => {
            "mend the file: names first, as `t,x`, then numbers with a decimal point, with commas, semicolons or tabs between them"
        }
        "bad-span" => "leave out `log`, or begin above 0",
        "too-many-runs" => "give fewer values, or cut the sweep into several",
        "spatial-only" => "leave it out, or write `space: spatial`",
        "planar-only" => "leave it out, or write `space: planar`",
        "duplicate-name" => "rename one of the two",
        "gravity-field" => "write `gravity` as a vector, or `none`",
        "missing-key" => "add what is expected",
        "no-column" => "take one of the columns of the file",
        "no-coordinate" => "let it depend on a position of a joint or of a body, as `O.angle` or `b.x`",
        "no-file" => "give its path as seen from the model file, and look whether it is there",
        "no-line" | "no-mass" => "take another mass of `attached`",
        "same-joint" | "wrong-joint" => "take another joint, or another kind of joint",
        "swept-and-solved" => "let the sweep or `solve` vary another parameter",
        "two-kinds" => "keep one of them",
        "unknown-mass" => "give the body such a mass in `attached`",
        "unknown-name" => "take one of the names that are expected",
        "unknown-point" => "take another point of the body, or add one to its `points`",
        "urdf" => "give a file whose root is `<robot name=\"..\">`",
        "wrong-dimension" => "divide it by a unit, as `x/1 m`, or multiply it with one",
        "wrong-level" => "take what is known there, or move the expression to where all is known",
        "wrong-plot" => "show it in a figure of its own",
        "wrong-size" => "write as many as are expected",
        "wrong-start" => "take a position or a velocity, as `O.angle`, `b.x` or `O.omega`",
        _ => return None,
    })
}
