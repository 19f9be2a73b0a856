//! The page itself: an overview, a section for each log, provenance.

pub mod diagnosis;
pub mod log;
pub mod parts;
pub mod recording;
pub mod replay;
pub mod results;
pub mod unknown;
pub mod whole;
