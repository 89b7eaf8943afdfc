//! Merged values → typed entities. Form was checked along the tables of fields; here names are resolved, expressions
//! lowered, dimensions checked. A value whose form is wrong is passed over in silence: it was reported already.

mod bodies;
mod checks;
mod clutches;
mod columns;
mod decoder;
mod drawn;
mod events;
mod forces;
mod frame;
mod friction;
mod gravity;
mod joints;
mod kinds;
mod measures;
mod order;
mod outside;
mod pictures;
mod plots;
mod points;
mod scalars;
mod springs;
mod start;
mod stops;
mod studies;
mod sweeps;
mod units;
mod values;
mod written;

pub(crate) use bodies::{BODY, PLACED};
pub(crate) use clutches::CLUTCH;
pub(crate) use decoder::{Decoder, Parsed};
pub(crate) use events::EVENT;
pub(crate) use forces::{COUPLING, DRIVER, LOAD, MOTOR};
pub(crate) use gravity::GRAVITY;
pub(crate) use joints::JOINT;
pub(crate) use measures::STATE;
pub(crate) use order::{in_words, order};
pub(crate) use outside::Outside;
pub(crate) use springs::SPRING;
pub(crate) use start::ROTATION;
pub(crate) use stops::REST_SPEED;
pub(crate) use studies::{STUDY, Scalars, StudyKeys, Taken};
pub(crate) use values::TABLE;
