//! Laws of captured objects: force over displacement with a history. They are no causes of the catalogue, but live beside them
//! because servo, fits and pictures share them. One law a file.

mod membrane;
mod toggle;
mod two_link;

pub use membrane::{MembraneHistory, MembraneLaw, MembranePhase, unloading_n};
pub use toggle::{CurvePoint, ToggleCurve};
pub use two_link::{TWO_LINK, TwoLinkMotion, TwoLinkParameter, TwoLinkRows};
