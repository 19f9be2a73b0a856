//! A force that never changes tells nothing of the mechanism: a constant of its own explains it, whatever the motion.

use super::parameters::{Known, Term};
use super::regress::Shown;
use super::report::{OBJECT, push_known};
use super::signals::{Piece, Raw};
use crate::identify::limits::ROUNDING;
use foundation::estimate::{Fit, Parameter};

/// The force that stands in every sample of all recordings; `None` where it changes.
fn level(raws: &[Raw]) -> Option<f64> {
    let all = || raws.iter().flat_map(|raw| raw.force.iter().flatten().copied());
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), f| (l.min(f), h.max(f)));
    (high - low <= ROUNDING * low.abs().max(high.abs())).then_some(low)
}

/// The answer to a motion under one force: that nothing of it can be known. `None` where the force changes, where the offset is known
/// (then the motion says how much resists), and where nothing moves (then the force is all that resists).
pub fn told_nothing(raws: &[Raw], pieces: &[Piece], seen: &Shown, known: &Known) -> Option<Fit> {
    let stands = seen.fitted.iter().all(|term| *term == Term::Offset);
    let force = level(raws).filter(|_| !stands && seen.fitted.contains(&Term::Offset))?;
    let coordinate = raws[0].coordinate;
    let name = Term::Offset.name(coordinate);
    let why = format!(
        "the force is {force} in every sample, and a constant explains it whatever moves; push with a force that changes, or state {name} in the sidecar if it is known"
    );
    let samples = pieces.iter().flat_map(|piece| &piece.usable).filter(|usable| **usable).count();
    let asked = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset];
    let open = asked.into_iter().filter(|term| known.value(*term).is_none());
    let mut result = Fit {
        task: "mechanism".to_owned(),
        parameters: open.map(|term| Parameter::unidentified(OBJECT, term.name(coordinate), samples, &why)).collect(),
        ..Fit::default()
    };
    push_known(&mut result, known, coordinate);
    Some(result)
}
