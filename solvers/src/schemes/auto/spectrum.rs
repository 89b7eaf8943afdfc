//! Spectral radius of the right-hand side of ẏ = F(t, y) by the power method on differences of F (as in explicit stabilised
//! schemes: Sommeijer, Shampine & Verwer, RKC, J. Comput. Appl. Math. 88, 1997, section 2.2).

use crate::engine::{Engine, Node, Why};
use crate::schemes::explicit::Flow;
use crate::{State, System};

/// Way of a difference, in sizes of the coordinates.
const REACH: f64 = 1e-7;

/// Iterations from no guess, and to follow the motion.
const SEARCH: usize = 20;
const FOLLOW: usize = 2;

/// The direction that grows fastest, and its rate.
#[derive(Clone, Debug)]
pub(super) struct Spectrum {
    /// Estimate of the largest |λ|, 1/s; 0 as long as none is known.
    pub(super) radius: f64,
    flow: Flow,
    /// Sizes of coordinates, velocities and states z.
    size: Vec<f64>,
    /// The entries of velocities begin and end here.
    speeds: [usize; 2],
    direction: Vec<f64>,
    y: Vec<f64>,
    near: Vec<f64>,
    rate: Vec<f64>,
    difference: Vec<f64>,
}

impl Spectrum {
    /// Room for a system.
    pub(super) fn new(system: &dyn System) -> Self {
        let (dims, pattern) = (system.dims(), system.pattern());
        let flow = Flow::new(system, false);
        let vector = vec![0.0; flow.n];
        let size = pattern.size_q.iter().chain(&pattern.size_v).copied();
        Self {
            radius: 0.0,
            size: size.chain((0..dims.z).map(|_| 1.0)).collect(),
            speeds: [dims.q, dims.q + dims.v],
            direction: vector.clone(),
            y: vector.clone(),
            near: vector.clone(),
            rate: vector.clone(),
            difference: vector,
            flow,
        }
    }

    /// Finds the radius at a node from the direction of all coordinates.
    ///
    /// # Errors
    /// If the system cannot be evaluated near the node.
    pub(super) fn search(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node) -> Result<f64, Why> {
        // uneven in size and sign, so that no symmetric motion is missed
        self.direction
            .iter_mut()
            .zip(&self.size)
            .enumerate()
            .for_each(|(i, (d, s))| *d = s * (2.0 * (0.75 + 0.618 * i as f64).fract() - 1.0));
        self.iterate(system, engine, node, SEARCH)?;
        Ok(self.radius)
    }

    /// Follows the radius to a node.
    ///
    /// # Errors
    /// If the system cannot be evaluated near the node.
    pub(super) fn improve(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node) -> Result<(), Why> {
        if self.direction.iter().all(|d| *d == 0.0) {
            return self.search(system, engine, node).map(|_| ());
        }
        self.iterate(system, engine, node, FOLLOW)
    }

    fn iterate(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, iterations: usize) -> Result<(), Why> {
        self.flow.begin(system, node, &mut self.y, &mut self.rate);
        let State { t, live, .. } = &node.state;
        let mut last = None;
        for _ in 0..iterations {
            let length = self.length(&self.direction);
            if !(length > 0.0 && length < f64::INFINITY) {
                break;
            }
            // velocities go no farther than coordinates, each in their own sizes: forces may be steep
            let step = REACH / length.max(self.weighted(&self.direction, 1.0));
            for ((x, y), d) in self.near.iter_mut().zip(&self.y).zip(&self.direction) {
                *x = y + step * d;
            }
            self.flow.rates(system, engine, (*t, live), &self.near, &mut self.difference)?;
            for (x, r) in self.difference.iter_mut().zip(&self.rate) {
                *x = (*x - r) / step;
            }
            let grown = self.length(&self.difference);
            // positions and velocities of an oscillation change places: what two differences do is its square, in whatever units
            let growth = grown / length;
            last = match last.take() {
                None => Some(growth),
                Some(before) => {
                    self.radius = f64::sqrt(before * growth);
                    None
                }
            };
            if grown > 0.0 {
                // of unit length: a direction that is followed for a whole run would overflow
                self.difference.iter_mut().for_each(|x| *x /= grown);
            }
            std::mem::swap(&mut self.direction, &mut self.difference);
        }
        Ok(())
    }

    /// Length in sizes; a velocity counts 1/radius, which makes both parts of the fastest oscillation the same.
    fn length(&self, x: &[f64]) -> f64 {
        self.weighted(x, if self.radius > 0.0 { self.radius.recip() } else { 1.0 })
    }

    fn weighted(&self, x: &[f64], weight: f64) -> f64 {
        let [first, last] = self.speeds;
        let square = |(i, (x, s)): (usize, (&f64, &f64))| {
            let x = x / s * if i >= first && i < last { weight } else { 1.0 };
            x * x
        };
        x.iter().zip(&self.size).enumerate().map(square).sum::<f64>().sqrt()
    }
}
