//! Laws of contacts and grasps: they act on no coordinate, so each has its formula as a plain function. One law a file.

mod cushion;
mod densification;
mod fingertip_slip;
mod pad_compliance;
mod stiffness_hardening;
mod velocity_loss;

pub use cushion::Cushion;
pub use densification::{CLOSED, Densification, ONSET};
pub use fingertip_slip::FingertipSlip;
pub use pad_compliance::PadCompliance;
pub use stiffness_hardening::StiffnessHardening;
pub use velocity_loss::VelocityLoss;

use super::entry::Entry;

/// Their pages of the catalogue.
pub static ENTRIES: [&Entry; 4] =
    [&PadCompliance::ENTRY, &StiffnessHardening::ENTRY, &FingertipSlip::ENTRY, &VelocityLoss::ENTRY];
