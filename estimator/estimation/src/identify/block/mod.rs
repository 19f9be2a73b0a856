//! Weight, width, height and friction of stacked blocks (thesis, tables 5.2 to 5.4), with standard errors.
//!
//! The thesis's formulas are means over a segment. Here each is the intercept of a small regression, which takes
//! disturbances of the thesis's numbers out if the recording shows them: accelerations from the weight, the give of the
//! pads from the width (it grew 7 % too narrow there) and from the height. Otherwise the standard error includes them.

mod friction_coefficient;
mod height_slip_correction;
pub(crate) mod heights;
mod joint_fit;
mod leak;
mod pad_stiffness;
pub mod placement_time;
pub mod rests;
pub mod signals;
mod single_fit;
pub mod slip_detection;
mod weight;
pub(crate) mod width;

pub use joint_fit::{JointFit, fit_jointly};
pub use single_fit::{fit, fit_by};
