//! The JSON file of a study: what was set, what came out, where the extremes are, and how far to trust it.

use serde_json::{Map, Value, json};

/// What the JSON file says, in the order it says it.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The study's name.
    pub study: String,
    /// `ok`, `failed`, ...
    pub status: String,
    /// The parameters the study ran with, SI.
    pub parameters: Vec<(String, f64)>,
    /// Results; numbers by [`json_number`], lists by [`json_numbers`].
    pub scalars: Vec<(String, Value)>,
    /// For each column its extremes, on the continuous solution.
    pub extrema: Vec<(String, Extrema)>,
    /// Figures of merit: drifts, residuals, step counts.
    pub certificate: Vec<(String, Value)>,
    /// What the user should know.
    pub findings: Vec<Finding>,
}

/// One remark with a stable code.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Finding {
    /// A stable identifier, to be searched for.
    pub code: String,
    /// One sentence for people.
    pub message: String,
    /// Where in the model, `joints.A`; empty if nowhere in particular.
    pub path: String,
}

/// A value and the independent variable where it occurs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The extreme value.
    pub value: f64,
    /// The independent variable there.
    pub at: f64,
}

/// Least and greatest value of a column; none if the column holds no number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extrema {
    /// The least value, where it occurs first.
    pub min: Option<Extreme>,
    /// The greatest value, where it occurs first.
    pub max: Option<Extreme>,
}

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
pub fn write_json(report: &Report) -> String {
    let object = |entries: &[(String, Value)]| Value::Object(entries.iter().cloned().collect());
    let extreme = |extreme: Option<Extreme>| {
        let Extreme { value, at } = extreme.unwrap_or(Extreme { value: f64::NAN, at: f64::NAN });
        json!({ "value": json_number(value), "at": json_number(at) })
    };
    let parameters: Map<_, _> = report.parameters.iter().map(|(name, x)| (name.clone(), json_number(*x))).collect();
    let extrema: Map<_, _> =
        report.extrema.iter().map(|(name, e)| (name.clone(), json!({ "min": extreme(e.min), "max": extreme(e.max) }))).collect();
    let findings = report.findings.iter().map(|f| json!({ "code": f.code, "message": f.message, "path": f.path }));
    let whole = json!({
        "study": report.study,
        "status": report.status,
        "parameters": parameters,
        "scalars": object(&report.scalars),
        "extrema": extrema,
        "certificate": object(&report.certificate),
        "findings": findings.collect::<Vec<_>>(),
    });
    // The alternate form of a Value is its indented text, and it cannot fail.
    format!("{whole:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_report_reads_back_in_its_order_with_null_for_no_number() {
        let theta = Extrema { min: Some(Extreme { value: -1.0, at: 2.0 }), max: Some(Extreme { value: 2.5, at: 1.0 }) };
        let report = Report {
            study: "one-turn".into(),
            status: "ok".into(),
            parameters: vec![("z".into(), 1.0), ("a".into(), f64::NAN)],
            scalars: vec![("eigenvalues".into(), json_numbers(&[0.1, f64::INFINITY]))],
            extrema: vec![("theta".into(), theta), ("none".into(), Extrema::default())],
            findings: vec![Finding { code: "jump".into(), message: "a jump".into(), path: "forces.load".into() }],
            ..Report::default()
        };
        let text = write_json(&report);
        let value: Value = serde_json::from_str(&text).unwrap();
        let keys: Vec<_> = value.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, ["study", "status", "parameters", "scalars", "extrema", "certificate", "findings"]);
        assert_eq!(value["parameters"], json!({ "z": 1, "a": null }));
        assert_eq!(value["scalars"]["eigenvalues"], json!([0.1, null]));
        assert_eq!(value["extrema"]["theta"]["max"], json!({ "value": 2.5, "at": 1 }));
        assert_eq!(value["extrema"]["none"]["min"], json!({ "value": null, "at": null }));
        assert!(text.find("\"z\"") < text.find("\"a\""), "parameters keep their order");
    }
}
