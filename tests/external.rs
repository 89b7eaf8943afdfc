//! Mechanisms of other simulators with their published results, and problems with references of many digits: `external/cases.json`.
//!
//! `GRASHOF_BLESS=1 cargo test --test all external` writes `docs/verification.md` and its pictures anew.

mod cases;
mod manual;

use cases::{Comparison, comparisons};
use std::collections::BTreeSet;
use std::fs;

/// Digits against equations integrated by hand that every case with such an integration must have.
const BY_HAND: f64 = 6.0;

fn all() -> Vec<&'static Comparison> {
    let failed: Vec<&String> = comparisons().iter().filter_map(|c| c.as_ref().err()).collect();
    assert!(failed.is_empty(), "{} cases do not run: {failed:#?}", failed.len());
    comparisons().iter().flatten().collect()
}

#[test]
fn published_results_are_met() {
    let all = all();
    let short = |c: &&&Comparison| c.digits < c.case.expect && c.by_hand.is_none_or(|d| d < BY_HAND);
    let tell = |c: &&Comparison| {
        let column = &c.case.columns[c.worst].name;
        format!(
            "{}: {:.1} digits, wanted {}; by hand {:?}; worst {column}, off by {:e}",
            c.case.id, c.digits, c.case.expect, c.by_hand, c.off
        )
    };
    let faults: Vec<String> = all.iter().filter(short).map(tell).collect();
    assert!(faults.is_empty(), "{} of {} cases\n{}", faults.len(), all.len(), faults.join("\n"));
    assert!(all.len() >= 73, "{} cases", all.len());
}

/// A reference file that no case reads, or a model that none runs, would only seem to be checked.
#[test]
fn every_model_and_reference_is_used() {
    let mut used = BTreeSet::new();
    for case in cases::cases() {
        used.extend([Some(case.model), Some(case.reference), case.hand].into_iter().flatten());
    }
    for directory in ["models", "refs"] {
        for entry in fs::read_dir(cases::root().join("tests/external").join(directory)).unwrap() {
            let path = entry.unwrap().path();
            assert!(path.is_dir() || used.contains(&path), "{} belongs to no case", path.display());
        }
    }
}

#[test]
fn the_manual_states_what_is_measured() {
    let all = all();
    if std::env::var_os("GRASHOF_BLESS").is_some() {
        manual::write(&all);
    }
    let stated = manual::stated();
    let names = |list: Vec<&String>| list.into_iter().cloned().collect::<Vec<_>>();
    assert_eq!(names(stated.iter().map(|s| &s.0).collect()), names(all.iter().map(|c| &c.case.id).collect()), "cases of the page");
    for ((name, digits), c) in stated.iter().zip(&all) {
        // the last digit of the program's own rounding may differ between machines
        assert!(c.digits > digits - 1.0, "{name}: the page states {digits} digits, there are {:.1}", c.digits);
        let picture = manual::figures().join(format!("{name}.svg"));
        assert_eq!(picture.is_file(), manual::has_picture(c), "{}", picture.display());
    }
    let pictures = fs::read_dir(manual::figures()).unwrap().count();
    assert_eq!(pictures, all.iter().filter(|c| manual::has_picture(c)).count(), "pictures of no case");
}
