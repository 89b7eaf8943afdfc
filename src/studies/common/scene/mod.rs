//! The scene of a study: what is drawn of its mechanism, and the poses of its motion.

mod anchors;
mod arrows;
mod asked;
mod frames;
mod gears;
mod guides;
mod joints;
mod links;
mod places;
mod senses;
mod shafts;
mod shapes;
mod teeth;
mod traces;
mod turn;

pub(crate) use arrows::fill_arrows;
pub(crate) use asked::beyond;
pub(crate) use frames::Span;
pub(crate) use places::extent;

use super::case::Case;
use super::motion::Motion;
use super::named::shown_in;
use crate::expression::Dimension;
use crate::geometry::{Pose, Space};
use crate::mechanism::Mechanism;
use crate::model::{Side, View};
use crate::results::Scene;
use crate::results::scene::Frames;
use std::f64::consts::TAU;

/// Whole turns of a range of which each has its own cells of the first grid, at most.
const MOST_TURNS: f64 = 20.0;
/// Name of the drawing of a motion.
pub(crate) const MECHANISM: &str = "mechanism";

/// The drawing of a study, if drawings are wanted of it.
#[must_use]
pub(crate) fn wanted(case: Case<'_>, scene: impl FnOnce() -> Scene) -> Vec<(String, Scene)> {
    if case.drawn { vec![(MECHANISM.into(), scene())] } else { Vec::new() }
}

/// What is drawn: the mechanism of a run.
#[derive(Clone, Copy)]
pub(crate) struct Subject<'a, G: Space<S = f64>> {
    /// The run.
    pub(crate) case: Case<'a>,
    /// Its mechanism.
    pub(crate) mechanism: &'a Mechanism<G>,
}

impl<G: Space<S = f64>> Subject<'_, G> {
    /// The scene of a motion, which tells at any progress the independent variable and the poses of the bodies there.
    #[must_use]
    pub(crate) fn over(&self, span: Span, at: &mut frames::At<'_, G>) -> Scene {
        let shown = self.shown_at().or(span.at);
        let scene = self.with(frames::over(self.mechanism, Span { at: shown, ..span }, at), span.times);
        Scene { at: shown, ..scene }
    }

    /// The scene of given poses, the first one drawn strongly. What passes through them is no path.
    #[must_use]
    pub(crate) fn of_poses(&self, poses: &[Vec<Pose<G>>]) -> Scene {
        Scene { traces: Vec::new(), ..self.with(frames::of_poses(poses), None) }
    }

    /// The place that the study asks to be shown.
    fn shown_at(&self) -> Option<f64> {
        self.case.study.shown_at.map(|at| self.case.value(at)).filter(|at| at.is_finite())
    }

    /// All but the frames follows from the mechanism, and from them and the times between which they are, s.
    fn with(&self, frames: Frames, times: Option<[f64; 2]>) -> Scene {
        let Self { case, mechanism } = *self;
        let mut scene = Scene {
            dimensions: G::VECTOR,
            view: view(case),
            at: self.shown_at(),
            length: shown_in(case.model, Dimension::LENGTH),
            force: shown_in(case.model, Dimension::FORCE),
            torque: shown_in(case.model, Dimension::TORQUE),
            up: up(mechanism),
            bodies: shapes::bodies(case.model, mechanism),
            frames,
            ..Scene::default()
        };
        let held = links::held(case, mechanism, &scene);
        scene.links = links::links(case, mechanism, &scene, &held);
        scene.joints = joints::joints(case, mechanism, &scene);
        senses::tell(case, mechanism, times, &mut scene);
        scene.arrows = arrows::arrows(case, mechanism, &held);
        scene.gears = gears::gears(case.model, mechanism, &scene);
        gears::outline_wheels(mechanism, &scene.gears, &mut scene.bodies);
        teeth::cut(&mut scene);
        shafts::outline_shafts(mechanism, &mut scene);
        scene.traces = traces::traces(case, mechanism, &scene);
        if let Some(shown) = turn::first_cycle(&scene) {
            scene.frames.shown = shown;
        }
        scene
    }
}

/// The scene of a whole driven motion.
#[must_use]
pub(crate) fn of_motion<G: Space<S = f64>>(case: Case<'_>, motion: &mut Motion<'_, G>) -> Scene {
    let subject = Subject { case, mechanism: motion.driven.dynamics.mechanism };
    let (ends, length) = (motion.ends, motion.clock.length);
    let times = Some(ends.map(|s| motion.time(s)));
    // of a few whole turns the frames are at the same angles of each
    let turns = (length / TAU).round();
    let whole = (1.0..=MOST_TURNS).contains(&turns) && (length - turns * TAU).abs() < 1e-9;
    let first = if whole { frames::CELLS * turns as usize } else { frames::CELLS };
    // of a motion that is followed both ways the start is shown
    let at = (ends[0] < 0.0 && ends[1] > 0.0).then(|| motion.clock.value(0.0));
    let span = Span { ends, times, turns: whole && turns == 1.0, first, at, ..Span::default() };
    subject.over(span, &mut |s| Some((motion.clock.value(s), motion.poses(s)?)))
}

/// Azimuth and elevation of the eye, rad, if the study says where it is.
fn view(case: Case<'_>) -> Option<[f64; 2]> {
    let quarter = std::f64::consts::FRAC_PI_2;
    Some(match case.study.view? {
        View::Side(Side::Front) => [-quarter, 0.0],
        View::Side(Side::Top) => [-quarter, quarter],
        View::Side(Side::Right) => [0.0, 0.0],
        View::From { azimuth, elevation } => [azimuth, elevation].map(|angle| case.value(angle)),
    })
}

/// The direction that is upwards in a picture.
fn up<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> [f64; 3] {
    if G::VECTOR == 2 {
        return [0.0, 1.0, 0.0];
    }
    let length = G::dot(mechanism.gravity, mechanism.gravity).sqrt();
    if length > 0.0 { std::array::from_fn(|i| 0.0 - G::component(mechanism.gravity, i) / length) } else { [0.0, 0.0, 1.0] }
}
