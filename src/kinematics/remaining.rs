//! The motions that all rows leave, in words: which bodies move in them.

use super::assemble::Assembled;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use grashof_solvers::rank::Rank;

/// Part of the fastest body's speed in a motion below which a body rests in it.
const AT_REST: f64 = 1e-7;
/// Most bodies that are named.
const NAMED: usize = 6;

/// What the rows leave.
pub(super) struct Remaining {
    /// Which bodies move in it, behind the count of motions; empty if none is known to.
    pub(super) words: String,
    /// What to do, if more is known than that a driver or a joint is missing.
    pub(super) help: Option<String>,
}

/// Looks at the motions in a position.
pub(super) fn remaining<G: Space<S = f64>>(m: &Mechanism<G>, q: &[f64], start: &Assembled, rank: &Rank) -> Remaining {
    let balls: Vec<Option<Balls<G>>> = (0..m.bodies.len()).map(|b| between_balls(m, b)).collect();
    let mut dynamics = Dynamics::without_mass(m);
    dynamics.time(0.0, &start.modes);
    dynamics.position(q, &start.modes);
    // whether a body moves, and whether the balls do between which it hangs
    let mut moves = vec![[false; 2]; m.bodies.len()];
    for k in 0..rank.mobility {
        let mut parts = vec![0.0; rank.mobility];
        parts[k] = 1.0;
        dynamics.velocity(&rank.motion(&parts), &start.modes);
        let speeds = |b: usize| {
            let (twist, place) = (dynamics.work.twists[b], dynamics.work.places[b]);
            let turning = (0..3).map(|k| G::spin_component(twist.w, k).powi(2)).sum::<f64>();
            let ends = balls[b].iter().flat_map(|balls| balls.at).map(|at| norm::<G>(twist.at(place.point(at))));
            [start.size * turning.sqrt() + norm::<G>(twist.v), ends.fold(0.0, f64::max)]
        };
        let speeds: Vec<[f64; 2]> = (1..m.bodies.len()).map(speeds).collect();
        let fastest = speeds.iter().map(|[body, _]| *body).fold(0.0, f64::max);
        for (moves, speeds) in moves[1..].iter_mut().zip(speeds) {
            moves.iter_mut().zip(speeds).for_each(|(moves, speed)| *moves |= speed > AT_REST * fastest);
        }
    }
    let name = |b: usize| m.bodies[b].name.as_str();
    let spinning = |b: usize| balls[b].as_ref().filter(|_| moves[b] == [true, false]);
    let spins = (1..m.bodies.len()).filter_map(|b| Some((name(b), spinning(b)?.names)));
    let about = |(body, [a, c]): (&str, [&str; 2])| format!("`{body}` can spin about the line from joint `{a}` to joint `{c}`");
    let others: Vec<&str> = (1..m.bodies.len()).filter(|&b| moves[b][0] && spinning(b).is_none()).map(name).collect();
    let words = spins.clone().take(NAMED).map(about).chain(listed(&others));
    let help = spins.clone().next().map(|(body, [a, c])| {
        format!("make one of `{a}` and `{c}` a `universal` joint, or take a joint of the kind `distance` in the place of `{body}`")
    });
    Remaining { words: words.map(|words| format!("; {words}")).collect(), help }
}

fn norm<G: Space<S = f64>>(v: G::Vector) -> f64 {
    G::dot(v, v).sqrt()
}

/// The two spherical joints between which a body hangs.
struct Balls<'m, G: Space> {
    names: [&'m str; 2],
    /// Their places in the body.
    at: [G::Vector; 2],
}

/// The two spherical joints in which a body hangs, if no other joint holds it.
fn between_balls<G: Space<S = f64>>(m: &Mechanism<G>, body: usize) -> Option<Balls<'_, G>> {
    let mut joints = m.joints.iter().filter(|j| j.a.0 == body || j.b.0 == body);
    let [first, second] = [joints.next()?, joints.next()?];
    let balls = [first, second].iter().all(|j| j.kind == "spherical") && joints.next().is_none();
    let at = [first, second].map(|j| if j.a.0 == body { j.a.1 } else { j.b.1 });
    balls.then_some(Balls { names: [&first.name, &second.name], at })
}

/// "bodies `a` and `b` can still move".
fn listed(names: &[&str]) -> Option<String> {
    let quoted: Vec<String> = names.iter().take(NAMED).map(|name| format!("`{name}`")).collect();
    Some(match (&quoted[..], names.len().saturating_sub(NAMED)) {
        ([], _) => return None,
        ([only], _) => format!("body {only} can still move"),
        ([all @ .., last], 0) => format!("bodies {} and {last} can still move", all.join(", ")),
        (all, more) => format!("bodies {} and {more} more can still move", all.join(", ")),
    })
}
