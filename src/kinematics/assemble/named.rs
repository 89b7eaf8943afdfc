//! Coordinates that asked values name: those asked for themselves, those that a law of a driver puts somewhere, and hinges of the plane that
//! an asked angle leaves as the only unknown between its bodies.
//!
//! What is named needs no search. Along a chain of n bodies whose angles are all asked, rows of the search would have n²/2 entries.

use super::close::{Held, Named, System};
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Mechanism, Step};

impl<G: Space<S = f64>> System<'_, G> {
    /// Coordinates that asked values name take the values that these give them; a driver's law comes before a value of `start`.
    pub(super) fn take_named(&mut self, q: &mut [f64]) {
        let m = self.dynamics.mechanism;
        for start in &m.starts {
            let Asked::Gauge { gauge, order: 0 } = start.asked else { continue };
            if let Measured::Coordinate { along, .. } = m.gauges[gauge].measured {
                q[along.q] = start.value;
                self.named[along.v] = Some(if start.guess { Named::ByGuess } else { Named::Exactly });
            }
        }
        for drive in m.drives.iter().filter(|drive| !m.rows[drive.row].anchored) {
            let at = self.dynamics.work.motions[drive.output];
            if let Measured::Coordinate { along, .. } = m.gauges[drive.gauge].measured
                && at.is_finite()
            {
                q[along.q] = at;
                self.named[along.v] = Some(Named::Exactly);
            }
        }
        self.evaluate(q);
        let hinges = hinges(m);
        let mut turned = vec![0.0; m.nv];
        let asked = m.starts.iter().filter_map(|start| match start.asked {
            Asked::Gauge { gauge, order: 0 } if m.gauges[gauge].measured == Measured::Angle => Some((gauge, start)),
            _ => None,
        });
        // what is nearer to the ground names what hangs on it
        let mut angles: Vec<_> = asked.collect();
        angles.sort_by_key(|(gauge, _)| m.gauges[*gauge].columns.len());
        for (gauge, start) in angles {
            let (mut unknown, mut by_guess, mut known) = (None, start.guess, self.dynamics.work.readings[gauge].x);
            let mut single = true;
            for &(k, sign) in &m.gauges[gauge].columns {
                let Some((_, spin)) = hinges[k] else { continue };
                known += sign * spin * turned[k];
                match self.named[k] {
                    Some(named) => by_guess |= named == Named::ByGuess,
                    None => single &= unknown.replace((k, sign * spin)).is_none(),
                }
            }
            let (true, Some((k, spin))) = (single, unknown) else { continue };
            let Some((place, _)) = hinges[k] else { continue };
            turned[k] = spin * (start.value - known);
            q[place] += turned[k];
            self.named[k] = Some(if by_guess { Named::ByGuess } else { Named::Exactly });
        }
    }

    /// Whether exact values leave nothing to look for.
    pub(super) fn all_named_exactly(&self) -> bool {
        self.named.iter().all(|named| *named == Some(Named::Exactly))
    }

    /// Whether what is held names the coordinate of a column.
    pub(super) fn is_named(&self, column: usize) -> bool {
        match self.named[column] {
            Some(Named::Exactly) => self.held != Held::Nothing,
            Some(Named::ByGuess) => self.held == Held::All,
            None => false,
        }
    }
}

/// For each velocity column that turns what hangs on it in the plane, its coordinate and the sense, 1 or −1.
fn hinges<G: Space<S = f64>>(m: &Mechanism<G>) -> Vec<Option<(usize, f64)>> {
    let mut hinges = vec![None; m.nv];
    for step in &m.steps {
        if let Step::Axis { u, turns: true, q, v, .. } = *step {
            hinges[v] = Some((q, G::spin_component(u, 2).signum()));
        }
    }
    hinges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Planar;
    use crate::kinematics::assemble::close::CONVERGED;
    use crate::mechanism::{Coordinates, build};
    use crate::model::{Document, Selection};

    #[test]
    fn what_is_named_leaves_nothing_to_a_search() {
        // hinges either way round, a slide between, more than a turn, and a joint of which the coordinate is asked
        let text = "
grashof: 1
name: chain
space: planar
gravity: none
bodies:
  a: { bar: { length: 1 m, mass: 1 kg } }
  b: { bar: { length: 1 m, mass: 1 kg } }
  c: { bar: { length: 1 m, mass: 1 kg } }
  d: { bar: { length: 1 m, mass: 1 kg } }
  e: { bar: { length: 1 m, mass: 1 kg } }
joints:
  A: { revolute: [ground, a.start] }
  B: { revolute: [b.start, a.end] }
  C: { pin-in-slot: [b.end, c.start], axis: [1, 0] }
  D: { revolute: [d.start, c.end] }
  E: { revolute: [d.end, e.start] }
start: { d.angle: 700 deg, c.angle: ~-50 deg, a.angle: ~20 deg, B.angle: 30 deg, e.angle: ~10 deg }
";
        let model = Document::read(text, "chain.yaml").unwrap().model(&Selection::default()).unwrap();
        let mechanism = build::<Planar<f64>>(&model, &[], Coordinates::Joint).unwrap();
        let mut system = System::new(&mechanism);
        let mut q = mechanism.drawn();
        system.take_named(&mut q);
        assert!(system.miss(&q) < CONVERGED, "{:e}", system.miss(&q));
        let named: Vec<bool> = (0..mechanism.nv).map(|k| system.named[k].is_some()).collect();
        assert_eq!(named.iter().filter(|named| **named).count(), 5, "{named:?}");
    }
}
