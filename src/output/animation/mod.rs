//! A mechanism in motion: pictures of one scale at even steps of time, as GIF, as pixels for a film, and as SVG that moves.
//!
//! A [`Shot`] says when the pictures are taken, a [`Film`] lays them out as display lists by the same code as still pictures, and
//! [`Projector`], [`write_gif`] and [`moving_svg`] make files of them.

mod film;
mod gif;
mod paint;
mod palette;
mod shot;
mod smil;
mod tracks;

pub use film::{Film, Projector};
pub use gif::write_gif;
pub use shot::{Pace, Shot, ShotOptions};
pub use smil::moving_svg;
