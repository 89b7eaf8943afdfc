//! The JSON Schema of the JSON file of a study.

use serde_json::{Map, Value, json};

/// What certifies results: name, whether it is a count, and what it is.
const CERTIFICATE: [(&str, bool, &str); 22] = [
    ("rows", true, "Positions solved for the rows."),
    ("switches", true, "Switches that were located."),
    ("constraint_residual", false, "Largest residual of positions over the rows, m or rad."),
    ("power_balance", false, "Largest imbalance of power over the rows, relative to its largest term."),
    ("resolved_to", false, "Part of a column's largest magnitude that may be left out between known values."),
    ("unresolved", true, "Columns that are not resolved so far somewhere."),
    ("undeclared", true, "Functions from outside whose switches are not declared, so that none is located."),
    ("looks", true, "Evaluations of the motion for columns between rows."),
    ("velocity_residual", false, "Largest residual of velocities over the rows."),
    ("energy_drift", false, "Largest |E - E(0) - work| at the ends of steps, J."),
    ("energy_scale", false, "Largest energy or work, J."),
    ("widest_gap", false, "Widest gap between looks at conditions, s."),
    ("steps", true, "Steps."),
    ("rejected", true, "Steps that were made again."),
    ("evaluations", true, "Evaluations of the equations of motion."),
    ("tangents", true, "Exact tangents."),
    ("factorisations", true, "Factored matrices."),
    ("events", true, "Events at which the integration was restarted, or which were recorded."),
    ("bridges", true, "Singular positions that were crossed."),
    ("stepped_over", true, "Switches that were marched across."),
    ("unresolved_conditions", true, "Parts of steps in which a condition was not resolved."),
    ("runs", true, "Runs of a sweep."),
];

/// Of what [`write_json`](super::write_json) writes: `grashof schema --results`.
#[must_use]
pub fn results_schema() -> Value {
    let number = |about: &str| json!({ "type": ["number", "null"], "description": about });
    let count = |about: &str| json!({ "type": "integer", "minimum": 0, "description": about });
    let numbers = json!({ "type": "array", "items": { "type": ["number", "null"] } });
    let extreme = json!({
        "type": "object",
        "properties": { "value": number("The value, SI."), "at": number("The independent variable there, SI.") },
        "required": ["value", "at"],
    });
    let finding = json!({
        "type": "object",
        "properties": {
            "code": { "type": "string", "description": "A word to search for: `dead-point`." },
            "message": { "type": "string", "description": "In a sentence." },
            "path": { "type": "string", "description": "Path in the model file; empty if it belongs nowhere in particular." },
        },
        "required": ["code", "message", "path"],
        "additionalProperties": false,
    });
    let event =
        json!({ "type": "object", "properties": { "name": { "type": "string" }, "at": number("Time, s.") }, "required": ["name", "at"] });
    let solution = json!({
        "type": ["object", "null"],
        "properties": {
            "runs": count("Runs that were made."),
            "bracket": numbers,
            "target": number("The target."),
            "residual": number("The scalar less its target."),
        },
    });
    let mut certificate: Map<String, Value> =
        CERTIFICATE.iter().map(|(name, counts, about)| ((*name).to_string(), if *counts { count(about) } else { number(about) })).collect();
    certificate.insert("integrator".into(), json!({ "type": "string", "description": "The schemes that stepped." }));
    certificate.insert("happened".into(), json!({ "type": "array", "items": event, "description": "Events of the model." }));
    let solved = json!({ "anyOf": [solution, { "type": "array", "items": solution }], "description": "What certifies a solution; of a sweep one for each run." });
    certificate.insert("solve".into(), solved);
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Results of a study of Grashof",
        "description": "What `<study>.json` holds, and what `grashof run --json` prints in a list. All numbers are SI, angles in rad; `null` is what has no value. Of a sweep, scalars are lists over its runs.",
        "type": "object",
        "properties": {
            "study": { "type": "string", "description": "Name of the study." },
            "status": { "enum": ["done", "failed"], "description": "`failed` if the motion stopped on its way, or no run of a sweep finished: what was computed up to there is kept." },
            "variants": { "type": "array", "items": { "type": "string" }, "description": "Variants of the model that it was run with, in the order in which they change it; only if there are some." },
            "parameters": { "type": "object", "additionalProperties": number("Value of the parameter."), "description": "Values of the parameters, in file order; those of a sweep are those of the file." },
            "scalars": {
                "type": "object",
                "description": "Scalars of the study, of its kind, and those taken from others; lists that the kind gives; `shapes` of modes by coordinates; `linear` for a linearised motion.",
                "additionalProperties": { "type": ["number", "null", "array", "object"] },
            },
            "extrema": {
                "type": "object",
                "description": "Extremes of each column on the continuous motion, wherever its rows are.",
                "additionalProperties": { "type": "object", "properties": { "min": extreme, "max": extreme }, "required": ["min", "max"] },
            },
            "statistics": {
                "type": "object",
                "description": "Of a sweep whose values are drawn: how each number of its table is distributed over the runs that have it; `p5` is the value below which 5 of a hundred are.",
                "additionalProperties": {
                    "type": "object",
                    "properties": {
                        "runs": count("Runs that have the number."),
                        "mean": number("Mean."), "deviation": number("Standard deviation of the sample."),
                        "least": number("Least value."), "most": number("Largest value."),
                        "p5": number("5 % are below."), "p25": number("25 % are below."), "p50": number("The median."),
                        "p75": number("75 % are below."), "p95": number("95 % are below."),
                        "parts": {
                            "type": "object",
                            "description": "What each parameter that is drawn has to do with it, by the plane of least squares through the runs.",
                            "additionalProperties": {
                                "type": "object",
                                "properties": { "slope": number("Change of the number with the parameter, SI."), "share": number("Share of the variance: all together are 1 for a number that is linear in the parameters.") },
                                "additionalProperties": false,
                            },
                        },
                    },
                    "additionalProperties": false,
                },
            },
            "certificate": {
                "type": "object",
                "description": "How far to trust the results.",
                "properties": certificate,
            },
            "findings": { "type": "array", "items": finding, "description": "What a reader should know: why it stopped first, unmet expectations last." },
            "errors": { "type": "array", "items": { "type": "object" }, "description": "What was printed as errors, with `--json` only." },
        },
        "required": ["study", "status", "parameters", "scalars", "extrema", "certificate", "findings"],
        "additionalProperties": false,
    })
}
