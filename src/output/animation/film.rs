//! The pictures of a motion as display lists of one scale, and as pixels.

use super::paint::Canvas;
use super::shot::Shot;
use crate::output::drawing::{Plan, frame, margin, path_stroke, plan, position};
use crate::output::pose::{Drawing, Trace};
use crate::output::posed;
use crate::output::raster::RenderError;
use crate::output::scene::{Anchor, Color, Item, Scene as Sheet, Stroke};
use crate::output::thin::Point;
use crate::results::Scene;
use crate::results::scene::Place;

/// Pictures by which the extent of a motion is judged, about.
const LOOKED_AT: usize = 240;
/// Places along a path, at least.
const ALONG: usize = 360;
const LETTERS: f64 = 20.0;
/// Base line of what is told of a picture, below its title, pixels.
const READING: f64 = 66.0;
const PATH: f64 = 2.4;
const TIP: f64 = 4.5;

/// The path of a point.
#[derive(Clone, Debug)]
pub(super) struct Trail {
    pub(super) color: Color,
    /// Its places in pixels, `step` of them from picture to picture.
    pub(super) points: Vec<Point>,
    pub(super) step: usize,
}

/// A motion to be shown.
#[derive(Clone, Debug)]
pub struct Film<'a> {
    scene: &'a Scene,
    shot: &'a Shot,
    plan: Plan,
    /// What is the same in all pictures, below everything.
    pub(super) sheet: Sheet,
    pub(super) trails: Vec<Trail>,
}

impl<'a> Film<'a> {
    /// Lays out a motion: one scale and one extent for all of it. The parts of its title are as those of
    /// [`drawing`](crate::output::drawing).
    #[must_use]
    pub fn new(model: &str, study: &str, name: &str, scene: &'a Scene, shot: &'a Shot) -> Self {
        let poses = |x: &f64| scene.frames.at(*x, scene.dimensions);
        let some: Vec<f64> = shot.at.iter().step_by(shot.at.len().div_ceil(LOOKED_AT).max(1)).copied().collect();
        let seen: Vec<(&crate::results::scene::Trace, Vec<f64>)> =
            scene.traces.iter().filter_map(|trace| Some((trace, posed::traces::places(scene, trace)?))).collect();
        let step = step(shot, seen.iter().map(|(_, places)| places.as_slice()));
        let view = posed::view(scene);
        let along = shot.places(shot.steps * step);
        let path = |trace: &crate::results::scene::Trace| {
            let place = Place { body: trace.body, at: trace.at.clone() };
            Trace { name: trace.name.clone(), points: along.iter().map(|x| view.flat(scene.world(&poses(x), &place))).collect() }
        };
        let whole = Drawing {
            title: posed::title(model, study, name, &scene.caption),
            traces: seen.iter().map(|(trace, _)| path(trace)).collect(),
            ..posed::at_all(scene, &some)
        };
        let mut plan = plan(&whole);
        plan.forces.of_motion = true;
        let mut sheet = frame(&whole, &plan);
        margin(&whole, &plan, &mut sheet);
        let trail = |(index, trace): (usize, &Trace)| Trail {
            color: path_stroke(index).0,
            points: trace.points.iter().map(|p| plan.sheet.point(*p)).collect(),
            step,
        };
        let trails = whole.traces.iter().enumerate().map(trail).collect();
        Self { scene, shot, plan, sheet, trails }
    }

    /// When the pictures are taken.
    #[must_use]
    pub fn shot(&self) -> &Shot {
        self.shot
    }

    /// Number of pictures.
    #[must_use]
    pub fn count(&self) -> usize {
        self.shot.at.len()
    }

    /// The mechanism at a value of the independent variable, without paths.
    pub(super) fn mechanism(&self, x: f64) -> Vec<Item> {
        position(&posed::at(self.scene, x), &self.plan)
    }

    /// What is over the sheet in a picture: the mechanism, the paths up to there, the time or what stands for it.
    pub(super) fn picture(&self, index: usize) -> Vec<Item> {
        let mut over = Sheet { items: self.mechanism(self.shot.at[index]), ..Sheet::default() };
        for trail in &self.trails {
            let points: Vec<Point> =
                trail.points[..=index * trail.step].iter().filter(|p| p[0].is_finite() && p[1].is_finite()).copied().collect();
            let tip = points.last().copied();
            over.line(points, Stroke::solid(trail.color, PATH));
            tip.iter().for_each(|tip| over.circle(*tip, TIP, Some(trail.color), None));
        }
        over.items.extend(self.shot.readings.get(index).map(|text| self.reading(text)));
        over.items
    }

    /// What is told of a picture, below the title.
    pub(super) fn reading(&self, text: &str) -> Item {
        let mut over = Sheet::default();
        over.text([0.5 * self.sheet.width, READING], text.to_owned(), LETTERS, Anchor::Middle);
        over.items.remove(0)
    }
}

/// Places of each path from picture to picture: as many as the fastest part of one asks for, whose places in a still picture are given.
fn step<'p>(shot: &Shot, paths: impl Iterator<Item = &'p [f64]>) -> usize {
    let steps = shot.steps.max(1);
    let pictures = shot.places(steps);
    let within = |places: &[f64], ends: &[f64]| {
        let before = |x: f64| places.partition_point(|place| *place < x);
        before(ends[0].max(ends[1])).abs_diff(before(ends[0].min(ends[1])))
    };
    let most = paths.flat_map(|places| pictures.windows(2).map(move |ends| within(places, ends))).max().unwrap_or(0);
    most.clamp(ALONG.div_ceil(steps), (posed::traces::MOST / steps).max(ALONG.div_ceil(steps)))
}

/// Makes the pictures of a film as pixels; what does not move is painted once.
#[derive(Clone, Debug)]
pub struct Projector<'a> {
    pub(super) film: &'a Film<'a>,
    sheet: Canvas,
}

impl<'a> Projector<'a> {
    /// For pictures so many pixels wide, as high as the film asks for.
    #[must_use]
    pub fn new(film: &'a Film<'a>, width: usize) -> Self {
        let scale = width as f64 / film.sheet.width;
        let mut sheet = Canvas::new(width, (film.sheet.height * scale).ceil() as usize, scale);
        film.sheet.items.iter().for_each(|item| sheet.item(item));
        Self { film, sheet }
    }

    /// Width and height, pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.sheet.width, self.sheet.height]
    }

    /// Number of pictures.
    #[must_use]
    pub fn count(&self) -> usize {
        self.film.count()
    }

    /// A picture: red, green, blue of each pixel, row by row.
    #[must_use]
    pub fn rgb(&self, index: usize) -> Vec<u8> {
        let mut canvas = self.sheet.clone();
        self.film.picture(index).iter().for_each(|item| canvas.item(item));
        canvas.pixels
    }

    /// A picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// None that data could cause.
    pub fn png(&self, index: usize) -> Result<Vec<u8>, RenderError> {
        crate::output::raster::encode(&self.rgb(index), self.sheet.width, self.sheet.height)
    }

    /// Colours that are in all pictures: those of the display lists.
    pub(super) fn colors(&self) -> Vec<Color> {
        let middle = self.film.picture(self.film.count() / 2);
        let of = |item: &Item| match item {
            Item::Path { fill, stroke, .. } | Item::Circle { fill, stroke, .. } => [*fill, stroke.map(|s| s.color)],
            Item::Veil { color, .. } => [Some(*color), None],
            Item::Text(text) => [Some(text.color), None],
        };
        let mut colors: Vec<Color> = self.film.sheet.items.iter().chain(&middle).flat_map(of).flatten().collect();
        colors.push(crate::output::scene::WHITE);
        colors.sort_unstable();
        colors.dedup();
        colors
    }
}
