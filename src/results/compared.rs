//! What a comparison of integrators has come to.

use serde::{Deserialize, Serialize};

/// What an integrator came to with steps of one size.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ComparedRun {
    /// The integrator's name.
    pub integrator: String,
    /// Tolerance, or step in s.
    pub size: f64,
    /// From the first step to the last, s: the best of a few.
    pub time: f64,
    /// Steps, rejected ones, evaluations, factorisations.
    pub counts: [f64; 4],
    /// Error at the end.
    pub error: f64,
    /// Largest |E − E(0) − work| at the ends of steps, J.
    pub energy: f64,
    /// Largest residuals of positions and velocities.
    pub residuals: [f64; 2],
    /// Why it failed; empty if it did not.
    pub reason: String,
}

/// The references, and how well they agree.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct References {
    /// For implicit schemes, and for explicit ones: columns at the end.
    pub columns: [Vec<f64>; 2],
    /// Their integrators and tolerances.
    pub of: [(String, f64); 2],
    /// Their difference, as an error; none if there is one reference alone.
    pub agree: Option<f64>,
}

/// All that was compared.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// Name of the study.
    pub study: String,
    /// Names of its columns.
    pub columns: Vec<String>,
    /// Whether the sizes are those of fixed steps.
    pub fixed: bool,
    /// What the errors are measured by.
    pub references: References,
    /// One row for each integrator and size.
    pub rows: Vec<ComparedRun>,
}

impl Compared {
    /// What the sizes are.
    #[must_use]
    pub fn size(&self) -> &'static str {
        if self.fixed { "step" } else { "tolerance" }
    }

    /// The names of the integrators, in order.
    #[must_use]
    pub fn integrators(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.rows.iter().map(|r| r.integrator.as_str()).collect();
        names.dedup();
        names
    }

    /// How well the references agree, in a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let [a, b] = self.references.of.each_ref().map(|(by, tolerance)| format!("{by} at {tolerance:e}"));
        match self.references.agree {
            Some(off) => format!("references: {a} (for implicit integrators) and {b} (for explicit ones) agree to {off:.1e}"),
            None => format!(
                "reference: {a} alone, since the other family does not get through; errors of its own family may be larger than they seem"
            ),
        }
    }
}
