//! In which order the shapes of a picture in space are painted, so that what is nearer hides what is farther.

mod division;

use crate::output::outlines::hull;
use crate::output::pose::{Facet, Form};
use crate::output::sheet::corners;
use division::{Piece, divided};

/// What overlaps by less than this part of the picture does not hide each other.
const SLACK: f64 = 1e-4;

/// What is painted.
#[derive(Clone, Debug)]
pub(super) enum Painted {
    /// A shape as it is.
    Whole(usize),
    /// A part of a shape, where something lies between its parts.
    Part(usize, Facet),
}

impl Painted {
    /// The shape.
    pub(super) fn form(&self) -> usize {
        match self {
            Self::Whole(form) | Self::Part(form, _) => *form,
        }
    }
}

/// The shapes, the farthest first. `width` is how wide a bar is drawn, m.
pub(super) fn painted(forms: &[&Form], width: impl Fn(&Form) -> f64) -> Vec<Painted> {
    let solid = |form: &&Form| form.facets.iter().any(|facet| facet.corners.len() > 2);
    let found = if forms.iter().any(solid) { in_space(forms, width) } else { None };
    found.unwrap_or_else(|| {
        let mut order: Vec<usize> = (0..forms.len()).collect();
        order.sort_by(|a, b| forms[*a].depth.total_cmp(&forms[*b].depth));
        order.into_iter().map(Painted::Whole).collect()
    })
}

/// Shapes in the order of their facets; none if these are too many, or not finite.
fn in_space(forms: &[&Form], width: impl Fn(&Form) -> f64) -> Option<Vec<Painted>> {
    let whole = |form: &Form| {
        let around = corners(&form.kind);
        let middle = |axis: usize| around.iter().map(|p| p[axis]).sum::<f64>() / around.len().max(1) as f64;
        vec![Facet { corners: vec![[middle(0), middle(1), form.depth]], edges: Vec::new() }]
    };
    let pieces: Vec<Piece> = forms
        .iter()
        .enumerate()
        .flat_map(|(k, form)| {
            let facets = if form.facets.is_empty() { whole(form) } else { form.facets.clone() };
            facets.into_iter().map(move |facet| Piece { form: k, depth: form.depth, facet })
        })
        .collect();
    let all = || pieces.iter().flat_map(|piece| piece.facet.corners.iter().flatten());
    if pieces.len() > division::MOST || !all().all(|x| x.is_finite()) {
        return None;
    }
    let along = |axis: usize| pieces.iter().flat_map(move |piece| piece.facet.corners.iter().map(move |p| p[axis]));
    let span = |axis: usize| along(axis).fold(f64::NEG_INFINITY, f64::max) - along(axis).fold(f64::INFINITY, f64::min);
    let size = (0..3).map(span).fold(0.0, f64::max);
    let pieces = divided(pieces, size)?;
    let slack = SLACK * size;
    let regions = pieces.iter().map(|piece| Region::of(piece, forms[piece.form], &width, slack)).collect();
    let places = (0..pieces.len()).map(|k| k as f64).collect();
    Some(Order { pieces, regions, places, slack }.joined(forms.len()))
}

/// The convex area that a piece covers in the picture.
struct Region {
    outline: Vec<[f64; 2]>,
    least: [f64; 2],
    most: [f64; 2],
}

impl Region {
    fn of(piece: &Piece, form: &Form, width: &impl Fn(&Form) -> f64, slack: f64) -> Self {
        let flat: Vec<[f64; 2]> = piece.facet.corners.iter().map(|p| [p[0], p[1]]).collect();
        let around = |points: &[[f64; 2]], reach: f64| {
            points
                .iter()
                .flat_map(|[x, y]| [[x - reach, y - reach], [x - reach, y + reach], [x + reach, y - reach], [x + reach, y + reach]])
                .collect::<Vec<_>>()
        };
        let outline = match flat.len() {
            0 | 1 => hull(&around(&corners(&form.kind), slack)),
            2 => hull(&around(&flat, 0.5 * width(form))),
            _ => hull(&flat),
        };
        let bound = |axis: usize, sign: f64| outline.iter().map(|p| sign * p[axis]).fold(f64::NEG_INFINITY, f64::max) * sign;
        Self { least: [0, 1].map(|axis| bound(axis, -1.0) + slack), most: [0, 1].map(|axis| bound(axis, 1.0) - slack), outline }
    }

    /// Whether two areas overlap (by the separating edges of convex polygons).
    fn overlaps(&self, other: &Self, slack: f64) -> bool {
        let boxes = (0..2).all(|i| self.least[i] < other.most[i] && other.least[i] < self.most[i]);
        boxes && !self.is_beside(other, slack) && !other.is_beside(self, slack)
    }

    /// Whether one of the own edges, which go round counter-clockwise, has all of another area on its outer side.
    fn is_beside(&self, other: &Self, slack: f64) -> bool {
        let count = self.outline.len();
        (0..count).any(|k| {
            let (a, b) = (self.outline[k], self.outline[(k + 1) % count]);
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            let length = x.hypot(y);
            length > 0.0 && other.outline.iter().all(|p| (x * (p[1] - a[1]) - y * (p[0] - a[0])) < slack * length)
        })
    }
}

/// Pieces, and when each is painted.
struct Order {
    pieces: Vec<Piece>,
    regions: Vec<Region>,
    places: Vec<f64>,
    /// What overlaps by less does not count, m.
    slack: f64,
}

impl Order {
    /// Puts the pieces of each shape together again as far as nothing that overlaps them has to be painted in between.
    fn joined(mut self, forms: usize) -> Vec<Painted> {
        let mut of_form: Vec<Vec<usize>> = vec![Vec::new(); forms];
        self.pieces.iter().enumerate().for_each(|(k, piece)| of_form[piece.form].push(k));
        let mut painted: Vec<(f64, Painted)> = Vec::new();
        for (form, own) in of_form.iter().enumerate() {
            let groups = self.groups(own);
            let together = groups.len() == 1;
            for group in groups {
                let place = self.places[group[0]];
                if together {
                    painted.push((place, Painted::Whole(form)));
                } else {
                    painted.extend(self.parts(&group).into_iter().map(|facet| (place, Painted::Part(form, facet))));
                }
            }
        }
        painted.sort_by(|a, b| a.0.total_cmp(&b.0));
        painted.into_iter().map(|(_, what)| what).collect()
    }

    /// The pieces of one shape in as few groups as can be, each painted at one place.
    fn groups(&mut self, own: &[usize]) -> Vec<Vec<usize>> {
        if own.len() < 2 {
            return own.iter().map(|k| vec![*k]).collect();
        }
        // between which others a piece must be painted
        let mut spans: Vec<(f64, f64, usize)> = own
            .iter()
            .map(|&k| {
                let mut span = (f64::NEG_INFINITY, f64::INFINITY, k);
                for other in 0..self.pieces.len() {
                    if self.pieces[other].form != self.pieces[k].form && self.regions[k].overlaps(&self.regions[other], self.slack) {
                        let place = self.places[other];
                        if place < self.places[k] { span.0 = span.0.max(place) } else { span.1 = span.1.min(place) }
                    }
                }
                span
            })
            .collect();
        spans.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut groups: Vec<(f64, f64, Vec<usize>)> = Vec::new();
        for (after, before, k) in spans {
            match groups.iter_mut().find(|(from, to, _)| from.max(after) < to.min(before)) {
                Some((from, to, group)) => {
                    (*from, *to) = (from.max(after), to.min(before));
                    group.push(k);
                }
                None => groups.push((after, before, vec![k])),
            }
        }
        for (from, to, group) in &groups {
            let place = match (from.is_finite(), to.is_finite()) {
                (true, true) => 0.5 * (from + to),
                (true, false) => from + 0.5,
                (false, true) => to - 0.5,
                (false, false) => self.places[group[0]],
            };
            group.iter().for_each(|k| self.places[*k] = place);
        }
        groups.into_iter().map(|(_, _, group)| group).collect()
    }

    /// The facets of a group; those of a bar that follow each other as one.
    fn parts(&self, group: &[usize]) -> Vec<Facet> {
        let mut facets: Vec<Facet> = group.iter().map(|k| self.pieces[*k].facet.clone()).collect();
        while let Some((a, b)) = follows(&facets) {
            let next = facets[b].corners[1];
            facets[a].corners[1] = next;
            facets.remove(b);
        }
        facets
    }
}

/// Two lines of which the second begins where the first ends.
fn follows(facets: &[Facet]) -> Option<(usize, usize)> {
    let line = |facet: &Facet| <[[f64; 3]; 2]>::try_from(facet.corners.as_slice()).ok();
    let ends: Vec<_> = facets.iter().map(line).collect();
    let pairs = (0..ends.len()).flat_map(|a| (0..ends.len()).map(move |b| (a, b)));
    pairs.into_iter().find(|(a, b)| a != b && matches!((ends[*a], ends[*b]), (Some(x), Some(y)) if x[1] == y[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::pose::{FormKind, Width};

    fn face(corners: &[[f64; 3]]) -> Form {
        let kind = FormKind::Area { points: corners.iter().map(|p| [p[0], p[1]]).collect(), shade: 1.0 };
        let depth = corners.iter().map(|p| p[2]).sum::<f64>() / corners.len() as f64;
        Form { kind, depth, facets: vec![Facet { corners: corners.to_vec(), edges: vec![true; corners.len()] }] }
    }

    fn level([x, y]: [f64; 2], [width, height]: [f64; 2], z: f64) -> Form {
        face(&[[x, y, z], [x + width, y, z], [x + width, y + height, z], [x, y + height, z]])
    }

    fn bar(from: [f64; 3], to: [f64; 3]) -> Form {
        let kind = FormKind::Bar { from: [from[0], from[1]], to: [to[0], to[1]], width: Width::Given(0.1) };
        Form { kind, depth: 0.5 * (from[2] + to[2]), facets: vec![Facet { corners: vec![from, to], edges: vec![true] }] }
    }

    /// Which shapes are painted, those in parts with the corners of each.
    fn order(forms: &[Form]) -> Vec<(usize, usize)> {
        let all: Vec<&Form> = forms.iter().collect();
        let told = painted(&all, |_| 0.1).into_iter().map(|what| match what {
            Painted::Whole(form) => (form, 0),
            Painted::Part(form, facet) => (form, facet.corners.len()),
        });
        told.collect()
    }

    #[test]
    fn a_bar_that_goes_through_a_face_is_seen_on_both_sides_of_it() {
        let through = bar([-2.0, 0.5, -1.0], [2.0, 0.5, 1.0]);
        assert_eq!(order(&[level([-1.0, 0.0], [2.0, 1.0], 0.0), through.clone()]), [(1, 2), (0, 0), (1, 2)]);
        // one that passes in front or beside is one piece
        assert_eq!(order(&[bar([-2.0, 0.5, 0.2], [2.0, 0.5, 1.0]), level([-1.0, 0.0], [2.0, 1.0], 0.0)]), [(1, 0), (0, 0)]);
        assert_eq!(order(&[level([-1.0, 2.0], [2.0, 1.0], 0.0), through]).len(), 2);
    }

    #[test]
    fn shapes_are_cut_only_where_something_lies_between_their_parts() {
        // three bars that lie over each other in a ring: no order of whole ones shows them
        let beam = |from: [f64; 2], to: [f64; 2]| {
            let (x, y) = (to[0] - from[0], to[1] - from[1]);
            let length = x.hypot(y);
            let (u, v) = (-0.1 * y / length, 0.1 * x / length);
            face(&[
                [from[0] - u, from[1] - v, 0.0],
                [to[0] - u, to[1] - v, 1.0],
                [to[0] + u, to[1] + v, 1.0],
                [from[0] + u, from[1] + v, 0.0],
            ])
        };
        let ring = [beam([0.0, 0.0], [3.0, 0.0]), beam([2.7, -0.3], [1.2, 2.4]), beam([1.8, 2.4], [0.2, -0.4])];
        let told = order(&ring);
        assert!(told.len() > 3 && (0..3).all(|form| told.iter().any(|(other, _)| *other == form)), "{told:?}");
        // faces whose planes cut each other, but which do not meet
        let apart = [face(&[[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]]), level([2.0, 0.0], [1.0, 1.0], 2.5)];
        assert!(order(&apart).iter().all(|(_, corners)| *corners == 0));
    }

    #[test]
    fn what_is_placed_as_a_whole_stands_before_or_behind_a_face() {
        let ball = |z| Form::flat(FormKind::Disc { center: [0.9, 0.5], radius: 0.1, spoke: None }, z);
        // the face leans: at the ball it is at 0.9
        let leaning = face(&[[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]]);
        assert_eq!(order(&[ball(0.8), leaning.clone()]), [(0, 0), (1, 0)]);
        assert_eq!(order(&[ball(0.95), leaning]), [(1, 0), (0, 0)]);
    }

    #[test]
    fn what_is_small_and_far_from_the_origin_is_seen_alike() {
        let at = |x: f64| {
            let through = bar([x - 2.0, x + 0.5, x - 1.0], [x + 2.0, x + 0.5, x + 1.0]);
            order(&[level([x - 1.0, x], [2.0, 1.0], x), through])
        };
        assert_eq!(at(1e5), at(0.0));
        assert_eq!(at(0.0), [(1, 2), (0, 0), (1, 2)]);
    }

    #[test]
    fn what_is_not_finite_or_too_much_is_put_in_order_by_its_depth() {
        let bad = level([f64::NAN, 0.0], [1.0, 1.0], 1.0);
        assert_eq!(order(&[level([0.0, 0.0], [1.0, 1.0], 2.0), bad, level([0.0, 0.0], [1.0, 1.0], 0.0)]), [(2, 0), (1, 0), (0, 0)]);
        let many: Vec<Form> = (0..=division::MOST).rev().map(|k| level([0.0, 0.0], [1.0, 1.0], k as f64)).collect();
        let told = order(&many);
        assert!(told.len() == many.len() && told[0].0 == division::MOST && told[division::MOST].0 == 0);
    }
}
