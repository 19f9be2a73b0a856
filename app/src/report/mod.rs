//! `report.html`: everything that the other commands say of one or several logs, on one page that needs nothing else: no network, no
//! script, no font.
//!
//! * [`collect`] runs the stages, the same ones that the other commands run; what fails becomes a sentence.
//! * [`page`] writes the sections, [`chart`] the pictures in them (SVG, drawn in the window's colours), [`style`] the look.
//! * [`source`] and [`provenance`] say what went in, with hashes, so that it can be repeated.

pub mod chart;
pub mod collect;
pub mod of_files;
pub mod page;
pub mod provenance;
pub mod source;
pub mod style;
