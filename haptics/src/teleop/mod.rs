//! Teleoperation: the operator here, the world far away, a slow line between them.
//!
//! The servo's world stays the far one: recordings and scores are of its events. Everything at the operator's end is a
//! device of that servo, in one of two ways (`docs/delay.md`):
//!
//! * [`waved`]: force and motion go over the line in wave variables, which cannot give energy out, and the operator sees a
//!   picture that is late. Honest, and slow: move, wait, look.
//! * [`modelled`]: the operator touches a model of the far world that answers at once (predictive display and
//!   model-mediated control; Sheridan 1993, Mitra & Niemeyer 2008). The motion of the hand is sent there and done by a
//!   hand of its own. The pictures that come back correct the model, slowly enough that no force jumps.
//!
//! Force reaches the operator through the safety stage in both: that of the servo, which sends it over the line, or that of a
//! second [`crate::servo::Loop`] at the operator's end, on the model.

mod album;
mod delay;
mod far_hand;
mod guess;
mod model;
mod modelled;
mod picture;
#[cfg(test)]
mod tests;
mod view;
mod waved;

pub use delay::{Delay, Ends};
pub use guess::{GUESS_OFF, guess};
pub use model::Weighed;
pub use view::{Knock, View, ViewSource};

use crate::device::Device;
use crate::device::channel::ChannelError;

/// Puts a line between `operator` and the world that the servo runs. The view is for the operator's display.
pub fn connect(
    operator: Box<dyn Device>,
    ends: &Ends<'_>,
    delay: &Delay,
) -> Result<(Box<dyn Device>, ViewSource), ChannelError> {
    let (view, source) = view::view(ends.state, delay.predicted);
    let device: Box<dyn Device> = if delay.predicted {
        Box::new(modelled::ModelledHand::new(operator, ends, delay, view)?)
    } else {
        Box::new(waved::WavedHand::new(operator, ends, delay, view)?)
    };
    Ok((device, source))
}
