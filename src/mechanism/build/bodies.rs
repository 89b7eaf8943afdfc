//! Tables, masses and points.

use super::super::inertia;
use super::super::{Attached, Body, Outline, Solid, SolidForm};
use super::builder::Builder;
use crate::expression::{Id, LookupTable, TableError};
use crate::geometry::{MassProperties, Space};
use crate::model::{self, PointAt, PointRef, Shape, roll_pitch_yaw};
use crate::scalar::Scalar;
use std::sync::Arc;

/// What a shape gives: mass properties, the ends of a bar (else twice the origin), the outline.
struct Shaped<G: Space> {
    mass: MassProperties<G>,
    ends: [G::Vector; 2],
    outline: Option<Outline>,
}

impl<G: Space> Default for Shaped<G> {
    fn default() -> Self {
        Self { mass: MassProperties::default(), ends: [G::Vector::default(); 2], outline: None }
    }
}

impl<G: Space> Builder<'_, G> {
    /// Tables as numbers.
    pub(super) fn tables(&mut self) {
        let mut tables = Vec::new();
        for table in &self.model.tables {
            let points: Vec<(f64, f64)> =
                table.points.iter().map(|&(x, y)| (self.number(x, &table.place), self.number(y, &table.place))).collect();
            match LookupTable::new(&points, table.between, table.beyond) {
                Ok(table) => tables.push(table),
                Err(error) => self.table_fault(&table.place, &error),
            }
        }
        self.tables = Arc::from(tables);
    }

    fn table_fault(&mut self, place: &str, error: &TableError) {
        self.fault("table", place, error.to_string(), "points with strictly rising x", Some("sort the points by x".into()));
    }

    /// Bodies with their masses and points.
    pub(super) fn bodies(&mut self) {
        for (index, body) in self.model.bodies.iter().enumerate() {
            let Shaped { mass: mut bare, ends: bar, outline } = self.shape(index);
            let place = body.place.as_str();
            if let Some(id) = body.mass {
                bare.mass = G::S::constant(self.number(id, place));
            }
            if let Some(com) = &body.com {
                bare.com = G::vector(&self.triple(com, place));
            }
            if !body.inertia.is_empty() {
                let figures = self.figures(&body.inertia, place);
                bare.inertia = G::tensor(figures);
            }
            let mut points = Vec::with_capacity(body.points.len());
            for point in &body.points {
                let at = match &point.at {
                    PointAt::Origin => G::Vector::default(),
                    PointAt::Com => bare.com,
                    PointAt::Start => bar[0],
                    PointAt::End => bar[1],
                    PointAt::Given(ids) => G::vector(&self.triple(ids, place)),
                };
                points.push((point.name.clone(), at));
            }
            let mut attached = Vec::new();
            for extra in &body.attached {
                let mass = extra.mass.map_or(0.0, |id| self.number(id, &extra.place));
                let figures = self.figures(&extra.inertia, &extra.place);
                attached.push(Attached {
                    name: extra.name.clone(),
                    mass: MassProperties { mass: G::S::constant(mass), com: points[extra.at].1, inertia: G::tensor(figures) },
                });
            }
            let mass = attached.iter().fold(bare, |sum: MassProperties<G>, a| sum.join(a.mass));
            for (point, model) in points.iter_mut().zip(&body.points) {
                if matches!(model.at, PointAt::Com) {
                    point.1 = mass.com;
                }
            }
            let round = body.circle.as_ref().map(|circle| {
                let radius = self.length(circle.radius, place, "the radius is");
                let given = (!circle.axis.is_empty()).then_some(&circle.axis[..]);
                let axis = self.direction(given, [0.0, 0.0, 1.0], place);
                Outline::Disc { center: self.triple(&circle.at, place), axis, radius, thickness: 0.0 }
            });
            let outline = round.or(outline);
            let solids = body.solids.iter().map(|solid| self.solid(solid, place)).collect();
            let drawn = body.drawn.iter().map(|at| G::vector(&self.triple(at, place))).collect();
            self.mechanism.bodies.push(Body {
                name: body.name.clone(),
                mass,
                bare,
                attached,
                points,
                drawn,
                outline,
                solids,
                column: None,
            });
        }
    }

    fn solid(&mut self, solid: &model::Solid, place: &str) -> Solid {
        let form = match &solid.form {
            model::SolidForm::Box { size } => SolidForm::Box { size: size.map(|id| self.number(id, place)) },
            model::SolidForm::Cylinder { radius, length } => {
                SolidForm::Cylinder { radius: self.number(*radius, place), length: self.number(*length, place) }
            }
            model::SolidForm::Ball { radius } => SolidForm::Ball { radius: self.number(*radius, place) },
        };
        let angles = solid.rpy.map_or([0.0; 3], |rpy| rpy.map(|angle| self.number(angle, place)));
        Solid { form, at: self.triple(&solid.at, place), turned: roll_pitch_yaw(angles) }
    }

    /// Inertia figures Ixx, Iyy, Izz, Ixy, Ixz, Iyz from 1, 3 or 6 numbers.
    fn figures(&mut self, ids: &[Id], place: &str) -> [f64; 6] {
        let x: Vec<f64> = ids.iter().map(|id| self.number(*id, place)).collect();
        match x[..] {
            [i] => [i, i, i, 0.0, 0.0, 0.0],
            [xx, yy, zz] => [xx, yy, zz, 0.0, 0.0, 0.0],
            [xx, yy, zz, xy, xz, yz] => [xx, yy, zz, xy, xz, yz],
            _ => [0.0; 6],
        }
    }

    /// What the shape of a body gives.
    fn shape(&mut self, body: usize) -> Shaped<G> {
        let model = self.model;
        let body = &model.bodies[body];
        let place = body.place.as_str();
        let Some(shape) = &body.shape else { return Shaped::default() };
        let origin = G::Vector::default();
        match shape {
            Shape::Bar { length, mass, width, height } => {
                let l = self.length(*length, place, "the length is");
                let [m, b, h] = [*mass, *width, *height].map(|x| self.optional(x, place));
                let outline = Outline::Bar { from: [0.0; 3], to: [l, 0.0, 0.0], width: b, height: h };
                Shaped { mass: inertia::bar(m, l, b, h), ends: [origin, G::vector(&[l])], outline: Some(outline) }
            }
            Shape::BarBetween { from, to, mass, width, height } => {
                let (from, to) = (self.triple(from, place), self.triple(to, place));
                let [m, b, h] = [*mass, *width, *height].map(|x| self.optional(x, place));
                if from == to {
                    self.fault("no-length", place, "the bar begins and ends at one point".into(), "two points", Some("move `to`".into()));
                    return Shaped::default();
                }
                let outline = Some(Outline::Bar { from, to, width: b, height: h });
                Shaped { mass: inertia::bar_between(m, from, to, b, h), ends: [G::vector(&from), G::vector(&to)], outline }
            }
            Shape::Disc { radius, mass, thickness } => {
                let r = self.length(*radius, place, "the radius is");
                let [m, t] = [*mass, *thickness].map(|x| self.optional(x, place));
                let outline = Some(Outline::Disc { center: [0.0; 3], axis: [0.0, 0.0, 1.0], radius: r, thickness: t });
                Shaped { mass: inertia::disc(m, r, t), ends: [origin; 2], outline }
            }
            Shape::Plate { size, mass } => {
                let size = self.triple(size, place);
                let mass = inertia::block(self.optional(*mass, place), size);
                Shaped { mass, ends: [origin; 2], outline: Some(Outline::Block { size }) }
            }
            Shape::Ball { radius, mass } => {
                let r = self.length(*radius, place, "the radius is");
                let mass = inertia::ball(self.optional(*mass, place), r);
                Shaped { mass, ends: [origin; 2], outline: Some(Outline::Ball { radius: r }) }
            }
        }
    }

    fn length(&mut self, id: Id, place: &str, what: &str) -> f64 {
        let x = self.number(id, place);
        if x <= 0.0 && self.faults.is_empty() {
            self.fault("no-length", place, format!("{what} {x} m"), "more than 0 m", Some("give a positive length".into()));
        }
        x
    }

    /// The axes of a point in its body, if they are not those of the body; a matrix.
    pub(super) fn axes_of(&mut self, point: PointRef) -> Option<[[f64; 3]; 3]> {
        let body = &self.model.bodies[point.body];
        let rpy = body.points[point.point].rpy?;
        Some(roll_pitch_yaw(rpy.map(|angle| self.number(angle, &body.place))))
    }

    /// A named point: its body and place in the body frame.
    pub(super) fn at(&self, point: PointRef) -> (usize, G::Vector) {
        (point.body, self.mechanism.bodies[point.body].points[point.point].1)
    }
}
