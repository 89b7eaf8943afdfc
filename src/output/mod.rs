//! What a study leaves behind: CSV, JSON, figures, a drawing of the mechanism, a report, and the table on the terminal.
//!
//! This room knows results, which are names and numbers, and pictures, nothing of mechanics; every function here is
//! pure but [`Staging::commit`], [`prepare`], [`CsvRows`], [`RowFiles`] and those that read tables back, which alone touch a disc. Pictures go one road: a [`Figure`] or a [`Drawing`] is laid
//! out once as a display list (`scene`), which is then written as SVG text and painted as pixels, so the two always agree.

mod animation;
mod clip;
pub mod comparison;
mod content;
mod csv;
mod csv_rows;
mod drawing;
mod dxf;
mod figure;
mod figures;
mod font;
mod forces;
mod formats;
mod gltf;
mod heads;
mod json;
mod legend;
mod lettering;
mod manifest;
mod marks;
mod mat;
mod matrices;
mod measure;
mod moves;
mod naming;
mod outlines;
mod painting;
mod panel;
#[cfg(feature = "parquet")]
mod parquet;
mod picture;
mod plot;
mod poles;
mod polytope;
mod pose;
mod posed;
mod raster;
mod report;
mod results_schema;
mod retraced;
mod row_files;
mod row_writer;
mod scalars;
mod scene;
mod sheet;
mod staging;
mod svg;
mod symbols;
mod text;
mod thin;
mod ticks;
mod units;
mod view;
mod winding;
mod write_error;

pub use crate::results::number;
pub use animation::{Film, Pace, Projector, Shot, ShotOptions, moving_svg, write_gif};
pub use content::Spooled;
pub use csv::write_csv;
pub use csv_rows::CsvRows;
pub use drawing::{labels, render_drawing};
pub use dxf::write_dxf;
pub use figure::render_figure;
pub use figures::figures;
pub use formats::{Formats, files, run_files, tables};
pub use gltf::write_gltf;
pub use json::{json_number, json_numbers, write_json};
pub use lettering::Label;
pub use mat::{MatValue, write_mat};
pub use matrices::matrices;
#[cfg(feature = "parquet")]
pub use parquet::{ParquetTable, gather_parquet, write_parquet};
pub use picture::Picture;
pub use plot::{Axis, Curve, Figure, Mark, Scale};
pub use pose::{
    Drawing, Force, ForceKind, Form, FormKind, Gear, Link, LinkKind, Move, Outline, Placement, Symbol, SymbolKind, Trace, Width,
};
pub use posed::drawing;
pub use raster::RenderError;
pub use report::{LIVE_POLICY, Report, ReportFault, ReportModel, ReportRuns, ReportStudy, live_page};
pub use results_schema::results_schema;
pub use row_files::RowFiles;
pub use scalars::ten_digits;
pub use staging::{Staging, Written, prepare};
pub use text::summary;
pub use write_error::WriteError;
