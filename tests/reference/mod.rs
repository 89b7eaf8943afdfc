//! Reference values of `data/assignment.json`, the program's results, and how the two are compared.

pub(crate) mod motor;
pub(crate) mod program;
pub(crate) mod turning;

use serde_json::Value;
use std::path::Path;

/// A column with what it should be at whole degrees.
pub(crate) struct Series {
    pub(crate) name: &'static str,
    pub(crate) values: Vec<f64>,
    /// Absolute.
    pub(crate) tolerance: f64,
}

/// An extremum: value and angle.
pub(crate) struct Extremum {
    pub(crate) column: &'static str,
    /// `min` or `max`.
    pub(crate) which: &'static str,
    pub(crate) value: f64,
    pub(crate) tolerance: f64,
    pub(crate) at: f64,
}

/// The whole file.
pub(crate) fn read() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/assignment.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// The number at a path such as `load_zone/theta_c_rad`.
pub(crate) fn number(file: &Value, path: &str) -> f64 {
    file.pointer(&format!("/{path}")).and_then(Value::as_f64).unwrap_or_else(|| panic!("no number {path}"))
}

fn entry<'a>(file: &'a Value, path: &str) -> (&'a [Value], f64) {
    let entry = file.pointer(&format!("/{path}")).unwrap_or_else(|| panic!("no entry {path}"));
    let values = entry["values"].as_array().unwrap_or_else(|| panic!("no values in {path}"));
    (values, entry["tolerance"].as_f64().unwrap_or_else(|| panic!("no tolerance in {path}")))
}

/// A series of numbers.
pub(crate) fn series(file: &Value, name: &'static str, path: &str) -> Series {
    let (values, tolerance) = entry(file, path);
    Series { name, values: values.iter().map(|v| v.as_f64().unwrap()).collect(), tolerance }
}

/// A series of vectors, as its two components.
fn vectors(file: &Value, names: [&'static str; 2], path: &str) -> [Series; 2] {
    let (values, tolerance) = entry(file, path);
    [0, 1].map(|k| Series { name: names[k], values: values.iter().map(|v| v[k].as_f64().unwrap()).collect(), tolerance })
}

/// Every column of the crank-rocker over one turn.
pub(crate) fn crank_rocker(file: &Value, loaded: bool) -> Vec<Series> {
    let speed = number(file, "parameters/w");
    let case = if loaded { "with_load" } else { "without_load" };
    let degrees = || (0..=360).map(|k| f64::from(k).to_radians());
    let mut all = vec![
        Series { name: "theta", values: degrees().collect(), tolerance: 1e-14 },
        Series { name: "time", values: degrees().map(|theta| theta / speed).collect(), tolerance: 1e-12 },
        series(file, "det_J", "kinematics/det_J"),
        series(file, "tip_speed", "kinematics/tip/velocity_signed"),
        series(file, "tip_acc_tangential", "kinematics/tip/acc_tangential"),
        series(file, "tip_acc_centripetal", "kinematics/tip/acc_centripetal"),
        series(file, "tip_acc", "kinematics/tip/acc_total"),
        series(file, "inertia_eq", "equivalent_inertia/I"),
        series(file, "inertia_eq_slope", "equivalent_inertia/dI_dtheta"),
        series(file, "drive.torque", &format!("reactions/{case}/MO")),
        series(file, "shaking.f", "shaking/m_aG_abs"),
    ];
    for name in ["phi2", "phi3", "omega2", "omega3", "alpha2", "alpha3"] {
        all.push(series(file, name, &format!("kinematics/{name}")));
    }
    let power = series(file, "drive.power", &format!("reactions/{case}/MO"));
    all.push(Series { values: power.values.iter().map(|m| m * speed).collect(), tolerance: power.tolerance * speed, ..power });
    all.extend(vectors(file, ["com.x", "com.y"], "centre_of_mass/r_xy"));
    all.extend(vectors(file, ["com.vx", "com.vy"], "centre_of_mass/v_xy"));
    all.extend(vectors(file, ["com.ax", "com.ay"], "centre_of_mass/a_xy"));
    all.extend(vectors(file, ["shaking.fx", "shaking.fy"], "shaking/m_aG_xy"));
    let joints =
        [("O", ["O.fx", "O.fy", "O.f"]), ("A", ["A.fx", "A.fy", "A.f"]), ("B", ["B.fx", "B.fy", "B.f"]), ("G", ["C.fx", "C.fy", "C.f"])];
    for (joint, [x, y, size]) in joints {
        let [fx, fy] = vectors(file, [x, y], &format!("reactions/{case}/{joint}_xy"));
        let sizes = fx.values.iter().zip(&fy.values).map(|(x, y)| x.hypot(*y)).collect();
        all.push(Series { name: size, values: sizes, tolerance: 2.0 * fx.tolerance });
        all.extend([fx, fy]);
    }
    if loaded {
        all.push(series(file, "tip_force", "generalised/F_tip"));
        all.extend(vectors(file, ["frame.fx", "frame.fy"], "shaking/frame_force_xy_resist"));
    } else {
        let pair = |k: usize, name| {
            let of = |joint: &str| vectors(file, ["", ""], &format!("reactions/{case}/{joint}_xy"));
            let values = of("O")[k].values.iter().zip(&of("G")[k].values).map(|(o, c)| -(o + c)).collect();
            Series { name, values, tolerance: 2e-6 }
        };
        all.push(Series { name: "tip_force", values: vec![0.0; 361], tolerance: 0.0 });
        all.extend([pair(0, "frame.fx"), pair(1, "frame.fy")]);
    }
    all
}

/// Every extremum of a column of the crank-rocker.
pub(crate) fn extrema(file: &Value, loaded: bool) -> Vec<Extremum> {
    let case = if loaded { "resist" } else { "noload" };
    let mut all = Vec::new();
    let mut put = |column: &'static str, key: &str| {
        for which in ["min", "max"] {
            let Some(entry) = file.pointer(&format!("/extrema/{key}_{which}")) else { continue };
            all.push(Extremum {
                column,
                which,
                value: entry["values"].as_f64().unwrap(),
                tolerance: entry["tolerance"].as_f64().unwrap(),
                at: entry["theta_rad"].as_f64().unwrap(),
            });
        }
    };
    for name in ["phi2", "phi3", "omega2", "omega3", "alpha2", "alpha3", "det_J", "tip_acc_tangential", "tip_acc_centripetal"] {
        put(name, name);
    }
    put("tip_speed", "tip_speed_signed");
    put("tip_acc", "tip_acc_total");
    put("com.x", "com_rod070_x");
    put("com.y", "com_rod070_y");
    put("inertia_eq", "Ieq_rod070");
    put("O.f", &format!("O_force_rod070_{case}"));
    put("A.f", &format!("A_force_rod070_{case}"));
    put("B.f", &format!("B_force_rod070_{case}"));
    put("C.f", &format!("G_force_rod070_{case}"));
    put("drive.torque", &format!("MO_rod070_{case}"));
    put("shaking.f", "m_aG_rod070");
    all
}

/// Collects what does not agree, the worst place of each name only.
#[derive(Default)]
pub(crate) struct Verdict {
    faults: Vec<(String, f64, String)>,
    /// Comparisons made.
    pub(crate) compared: usize,
}

impl Verdict {
    /// `found` is `right` within `tolerance`; `name` says what, `place` says where.
    pub(crate) fn close(&mut self, name: &str, place: impl std::fmt::Display, found: f64, right: f64, tolerance: f64) {
        self.compared += 1;
        let off = (found - right).abs();
        if off <= tolerance {
            return;
        }
        let excess = if off.is_nan() { f64::INFINITY } else { off / tolerance };
        let text = format!("{name} at {place}: found {found}, right {right}, off by {off:.3e}, allowed {tolerance:.1e}");
        match self.faults.iter_mut().find(|(known, ..)| known == name) {
            Some(fault) if fault.1 < excess => *fault = (name.to_owned(), excess, text),
            Some(_) => {}
            None => self.faults.push((name.to_owned(), excess, text)),
        }
    }

    /// Any other demand.
    pub(crate) fn holds(&mut self, true_or: bool, text: impl Into<String>) {
        self.compared += 1;
        if !true_or {
            let text = text.into();
            self.faults.push((text.clone(), f64::INFINITY, text));
        }
    }

    /// Fails with all that did not agree.
    pub(crate) fn give(self, what: &str) {
        let texts: Vec<_> = self.faults.iter().map(|f| f.2.as_str()).collect();
        assert!(texts.is_empty(), "{what}: {} of {} comparisons by name fail:\n  {}", texts.len(), self.compared, texts.join("\n  "));
        assert!(self.compared > 0, "{what}: nothing compared");
    }
}
