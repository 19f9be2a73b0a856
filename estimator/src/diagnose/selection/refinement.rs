//! Repetition of a comparison with closer candidates around the values found.

use super::comparison::ChannelFit;
use foundation::estimate::EstimateError;

/// A comparison whose candidates, rows or weights follow from what was found before.
pub trait Refinement {
    /// Compares the candidates of this round. `before`: the round before.
    fn compare(&mut self, before: Option<ChannelFit>) -> Result<ChannelFit, EstimateError>;

    /// Lays the candidates of the next round around what this one found; false if another round would improve nothing.
    /// `round`: number of repetitions so far.
    fn close_in(&mut self, found: &ChannelFit, round: usize) -> bool;
}

/// The comparison, repeated at most this often.
pub fn refined(of: &mut dyn Refinement, most: usize) -> Result<ChannelFit, EstimateError> {
    let mut found = of.compare(None)?;
    for round in 0..most {
        if !of.close_in(&found, round) {
            break;
        }
        found = of.compare(Some(found))?;
    }
    Ok(found)
}
