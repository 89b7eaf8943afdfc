//! The JSON file of a study: what was set, what came out, where the extremes are, and how far to trust it.

use crate::results::{
    Extremes, Extremum, Finding, Happened, LinearSystem, March, PERCENTAGES, Part, Results, Run, Scalar, Solution, Statistics,
};
use serde_json::{Map, Value, json};

/// Names and values of an object, in order.
type Entries = Vec<(String, Value)>;

/// A JSON number, or `null` for what is not a finite number; whole numbers stand without `.0`, as in the CSV.
pub fn json_number(x: f64) -> Value {
    // Below 2^53 every whole number is exact in both forms; the sign of a negative zero is not worth a `-0.0`.
    if x.fract() == 0.0 && x.abs() < 9_007_199_254_740_992.0 { json!(x as i64) } else { json!(x) }
}

/// A JSON list of numbers.
pub fn json_numbers(values: &[f64]) -> Value {
    values.iter().copied().map(json_number).collect()
}

/// The text of the JSON file, indented by two, with a line end.
pub fn write_json(results: &Results) -> String {
    let several = results.table.reasons.is_some();
    let whole = if several {
        results.runs.iter().any(|run| run.results.as_ref().is_some_and(|r| r.stopped.is_none()))
    } else {
        results.stopped.is_none()
    };
    let parameters: Map<_, _> = results.parameters.iter().map(|p| (p.name.clone(), json_number(p.value))).collect();
    let extrema: Map<_, _> = results.extremes.iter().map(|(name, extremes)| (name.clone(), both(*extremes))).collect();
    let mut text = json!({
        "study": results.study,
        "status": if whole { "done" } else { "failed" },
        "parameters": parameters,
        "scalars": object(if several { of_runs(results) } else { of_run(results) }),
        "extrema": extrema,
        "certificate": object(if several { runs(results) } else { certificate(results) }),
        "findings": findings(results),
    });
    if !results.variants.is_empty() {
        text["variants"] = json!(results.variants);
    }
    if !results.statistics.is_empty() {
        text["statistics"] = results.statistics.iter().map(|s| (s.name.clone(), statistics(s))).collect::<Map<_, _>>().into();
    }
    // The alternate form of a Value is its indented text, and it cannot fail.
    format!("{text:#}\n")
}

fn object(entries: Entries) -> Value {
    Value::Object(entries.into_iter().collect())
}

/// How a number is distributed over runs.
fn statistics(of: &Statistics) -> Value {
    let mut entries: Entries = vec![("runs".into(), json_number(of.runs as f64))];
    let numbers = [("mean", of.mean), ("deviation", of.deviation), ("least", of.range[0]), ("most", of.range[1])];
    entries.extend(numbers.map(|(name, x)| (name.to_string(), json_number(x))));
    let part = |p: &Part| (p.parameter.clone(), json!({ "slope": json_number(p.slope), "share": json_number(p.share) }));
    entries.extend(PERCENTAGES.iter().zip(of.percentiles).map(|(p, x)| (format!("p{p}"), json_number(x))));
    if !of.parts.is_empty() {
        entries.push(("parts".into(), object(of.parts.iter().map(part).collect())));
    }
    object(entries)
}

/// The extremes of a column.
fn both(extremes: Option<Extremes>) -> Value {
    let nowhere = Extremum { value: f64::NAN, at: f64::NAN, piece: 0 };
    let one = |e: Extremum| json!({ "value": json_number(e.value), "at": json_number(e.at) });
    let [min, max] = extremes.map_or([nowhere; 2], |e| [e.min, e.max]);
    json!({ "min": one(min), "max": one(max) })
}

/// Scalars, and what the kind gives beside them.
fn of_run(results: &Results) -> Entries {
    let scalar = |s: &Scalar| (s.name.clone(), json_number(s.value));
    results.scalars.iter().map(scalar).chain(of_kind(results)).collect()
}

/// Lists, shapes and matrices of a kind.
fn of_kind(results: &Results) -> Entries {
    let lists = results.lists.iter().map(|list| (list.name.clone(), json_numbers(&list.values)));
    let shape = |shape: &Vec<(String, f64)>| Value::Object(shape.iter().map(|(name, x)| (name.clone(), json_number(*x))).collect());
    let shapes = (!results.shapes.is_empty()).then(|| ("shapes".into(), results.shapes.iter().map(shape).collect()));
    lists.chain(shapes).chain(results.linear.as_ref().map(|system| ("linear".into(), linear(system)))).collect()
}

/// Names, values and matrices of a linearised motion.
fn linear(system: &LinearSystem) -> Value {
    let mut entries: Entries = system.names().iter().map(|(name, list)| ((*name).to_string(), Value::from(list.to_vec()))).collect();
    entries.extend(LinearSystem::VALUES.iter().zip(&system.values).map(|(name, values)| ((*name).to_string(), json_numbers(values))));
    let matrix = |rows: &Vec<Vec<f64>>| rows.iter().map(|row| json_numbers(row)).collect();
    entries.extend(system.matrices.iter().map(|(name, rows)| (name.clone(), matrix(rows))));
    object(entries)
}

/// Columns of the table of a sweep, and what the kind gives beside numbers: one entry of each run, `null` where there is none.
fn of_runs(results: &Results) -> Entries {
    let mut entries: Entries = results.table.columns.iter().map(|column| (column.name.clone(), json_numbers(&column.values))).collect();
    let all: Vec<Entries> = results.runs.iter().map(|run| run.results.as_deref().map_or_else(Vec::new, of_kind)).collect();
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in all.iter().flatten() {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let entry = |own: &Entries, name: &str| own.iter().find(|(known, _)| known == name).map_or(Value::Null, |(_, v)| v.clone());
    entries.extend(names.iter().map(|name| ((*name).to_string(), all.iter().map(|own| entry(own, name)).collect())));
    entries
}

/// What certifies the runs of a sweep.
fn runs(results: &Results) -> Entries {
    let count = ("runs".into(), json_number(results.runs.len() as f64));
    let solves = results.runs.iter().any(|run| run.solution.is_some());
    let solved = |run: &Run| run.solution.as_ref().map_or(Value::Null, solution);
    let solved = solves.then(|| ("solve".into(), results.runs.iter().map(solved).collect()));
    std::iter::once(count).chain(solved).collect()
}

/// What certifies a solution.
fn solution(solved: &Solution) -> Value {
    json!({
        "runs": solved.runs,
        "bracket": json_numbers(&solved.bracket),
        "target": json_number(solved.target),
        "residual": json_number(solved.found - solved.target),
    })
}

/// What certifies a run.
fn certificate(results: &Results) -> Entries {
    let c = &results.certificate;
    let mut all = vec![count("rows", c.evaluations), count("switches", c.switches), figure("constraint_residual", c.constraint)];
    if let Some(r) = &c.resolved {
        all.extend([figure("resolved_to", r.width), count("unresolved", r.open), count("looks", r.evaluations)]);
    }
    if c.undeclared > 0 {
        all.push(count("undeclared", c.undeclared));
    }
    match &c.march {
        Some(march) => all.extend(motion(march, &results.events)),
        None => all.push(figure("power_balance", c.power_balance)),
    }
    all.into_iter().chain(results.solution.as_ref().map(|s| ("solve".into(), solution(s)))).collect()
}

/// What certifies a motion in time.
fn motion(march: &March, events: &[Happened]) -> Entries {
    let happened = events.iter().map(|e| json!({ "name": e.name, "at": json_number(e.at) }));
    let mut all = vec![
        figure("velocity_residual", march.velocity),
        ("integrator".into(), Value::String(march.schemes.clone())),
        ("happened".into(), happened.collect()),
        figure("energy_drift", march.energy_drift),
        figure("energy_scale", march.energy_scale),
    ];
    all.extend(march.works().map(|(name, work)| figure(name, work)));
    let counts = &march.counts;
    all.extend([
        figure("widest_gap", march.widest_gap),
        count("steps", counts.steps),
        count("rejected", counts.rejected),
        count("evaluations", counts.evaluations),
        count("tangents", counts.tangents),
        count("factorisations", counts.factorisations),
        count("events", counts.events),
        count("bridges", counts.bridges),
        count("stepped_over", counts.stepped_over),
        count("unresolved_conditions", counts.unresolved),
    ]);
    all
}

fn figure(name: &str, x: f64) -> (String, Value) {
    (name.to_string(), json_number(x))
}

fn count(name: &str, n: usize) -> (String, Value) {
    figure(name, n as f64)
}

/// What a reader should know: why it stopped, what was found, which expectations are not met.
fn findings(results: &Results) -> Value {
    let entry = |code: &str, message: &str, path: &str| json!({ "code": code, "message": message, "path": path });
    let stopped = results.stopped.iter().map(|reason| entry("stopped", reason, &results.place));
    let found = |f: &Finding| entry(&f.code, &f.message, &f.path);
    let own = results.findings.iter().chain(results.solution.iter().flat_map(|s| &s.findings)).map(found);
    let unmet = results.expectations.iter().filter(|e| !e.met).map(|e| entry("expectation", &e.message, &e.place));
    stopped.chain(own).chain(unmet).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{By, List};

    #[test]
    fn no_two_numbers_of_a_certificate_have_one_name() {
        let mut results = Results::default();
        results.certificate.resolved = Some(crate::results::Resolution { width: 1e-7, open: 2, evaluations: 9 });
        let mut march = March::default();
        march.counts.unresolved = 3;
        results.certificate.march = Some(march);
        let entries = certificate(&results);
        for (i, (name, _)) in entries.iter().enumerate() {
            assert!(entries[..i].iter().all(|(other, _)| other != name), "{name}");
        }
        let value: Value = serde_json::from_str(&write_json(&results)).unwrap();
        assert_eq!([&value["certificate"]["unresolved"], &value["certificate"]["unresolved_conditions"]], [&json!(2), &json!(3)]);
    }

    #[test]
    fn the_report_reads_back_in_its_order_with_null_for_no_number() {
        let at = |value, at| Extremum { value, at, piece: 0 };
        let parameter = |name: &str, value| Scalar { name: name.into(), value, by: By::File, ..Scalar::default() };
        let results = Results {
            study: "one-turn".into(),
            parameters: vec![parameter("z", 1.0), parameter("a", f64::NAN)],
            lists: vec![List { name: "eigenvalues".into(), values: vec![0.1, f64::INFINITY], ..List::default() }],
            extremes: vec![("theta".into(), Some(Extremes { min: at(-1.0, 2.0), max: at(2.5, 1.0) })), ("none".into(), None)],
            findings: vec![Finding { code: "jump".into(), message: "a jump".into(), path: "forces.load".into() }],
            ..Results::default()
        };
        let text = write_json(&results);
        let value: Value = serde_json::from_str(&text).unwrap();
        let keys: Vec<_> = value.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, ["study", "status", "parameters", "scalars", "extrema", "certificate", "findings"]);
        let varied = write_json(&Results { variants: vec!["motor".into(), "elastic".into()], ..Results::default() });
        assert_eq!(serde_json::from_str::<Value>(&varied).unwrap()["variants"], json!(["motor", "elastic"]));
        assert_eq!(value["parameters"], json!({ "z": 1, "a": null }));
        assert_eq!(value["scalars"]["eigenvalues"], json!([0.1, null]));
        assert_eq!(value["extrema"]["theta"]["max"], json!({ "value": 2.5, "at": 1 }));
        assert_eq!(value["extrema"]["none"]["min"], json!({ "value": null, "at": null }));
        assert!(text.find("\"z\"") < text.find("\"a\""), "parameters keep their order");
    }
}
