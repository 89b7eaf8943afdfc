//! The place of the motion at which a study asks to see it.

use crate::expression::Dimension;
use crate::model::{Study, in_unit};
use crate::results::{Finding, Scene, ShownIn};

/// Places beyond the ends by less than this part of the motion are at them.
const SLACK: f64 = 1e-9;

/// Tells that the motion does not get to where its drawing should show it; `name` is that of the independent variable,
/// `unit` the one that is asked for.
pub(crate) fn beyond(study: &Study, name: &str, unit: Option<ShownIn>, scene: &Scene) -> Option<Finding> {
    let (at, from, to) = (scene.at?, *scene.frames.at.first()?, *scene.frames.at.last()?);
    let slack = SLACK * (to - from);
    if (from - slack..=to + slack).contains(&at) {
        return None;
    }
    let dimension = study.independent.unwrap_or(Dimension::NONE);
    let (unit, size) = match unit {
        Some(asked) => (asked.unit, asked.size),
        None if dimension == Dimension::ANGLE => ("deg".into(), 1f64.to_radians()),
        None => (dimension.si(), 1.0),
    };
    let shown = |x: f64| in_unit(x / size, &unit);
    let message = format!(
        "the drawing shows {name} = {}, where the motion ends: it has no {}, only {} to {}",
        shown(at.clamp(from, to)),
        shown(at),
        shown(from),
        shown(to)
    );
    Some(Finding { code: "not-reached".into(), message, path: format!("{}.at", study.place) })
}
