//! `report.html`: the results of all commands for one or several logs, on one self-contained page: no network, no
//! script, no font.
//!
//! * [`collect`] runs the same stages as the other commands; a failure becomes a sentence.
//! * [`page`] writes the sections, [`chart`] the pictures in them (SVG, in the window's colours), [`style`] the look.
//! * [`source`] and [`provenance`] record the inputs with hashes, so that the report is reproducible.

pub mod chart;
pub mod collect;
pub mod of_files;
pub mod page;
pub mod provenance;
pub mod source;
pub mod style;
