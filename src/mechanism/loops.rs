//! Loops in words.

use super::{Joint, Mechanism};
use crate::geometry::Space;

/// The loop that a cut joint closes, as a path of names: `ground -O- crank -A- coupler -B- rocker -C- ground`.
#[must_use]
pub fn describe_loop<G: Space>(mechanism: &Mechanism<G>, joint: &Joint<G>) -> String {
    let up = |mut body: usize| {
        let mut path = vec![(body, String::new())];
        while let Some(node) = mechanism.nodes.iter().find(|n| n.body == body) {
            let index = mechanism.nodes.iter().position(|n| n.body == body);
            let name = mechanism.joints.iter().find(|j| j.tree.map(|t| Some(t.0)) == Some(index)).map_or("free", |j| &j.name);
            body = node.parent;
            path.push((body, name.to_string()));
        }
        path
    };
    let (mut a, mut b) = (up(joint.a.0), up(joint.b.0));
    // the roads share their end; keep one copy of the last common body
    while a.len() > 1 && b.len() > 1 && a[a.len() - 2].0 == b[b.len() - 2].0 {
        a.pop();
        b.pop();
    }
    let name = |body: usize| mechanism.bodies[body].name.as_str();
    let mut text = String::new();
    for (i, (body, via)) in a.iter().enumerate().rev() {
        text.push_str(name(*body));
        if i > 0 {
            let via = if via.is_empty() { "free" } else { via };
            text.push_str(&format!(" -{via}- "));
        }
    }
    text.push_str(&format!(" -{}- ", joint.name));
    for (i, (body, _)) in b.iter().enumerate() {
        text.push_str(name(*body));
        if let Some((_, via)) = b.get(i + 1) {
            text.push_str(&format!(" -{via}- "));
        }
    }
    text
}
