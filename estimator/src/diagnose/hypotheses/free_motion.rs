use crate::diagnose::data::regression_data::{Freely, Track};
use haptics::law::{EccentricMass, Effect, Inertia, Law as _};

/// The laws of what moves freely as a world has them: with its inertia and what is known, and gravity of both phases as
/// one law.
pub(crate) fn whole(track: &Track, laws: Vec<Effect>) -> Vec<Effect> {
    let Some(Freely { inertia, known, .. }) = track.freely else { return laws };
    let mut all = vec![Effect::new(&Inertia, &[inertia])];
    for law in laws.into_iter().chain(known.into_iter().flatten()) {
        let pulls = |e: &Effect| e.law().id() == EccentricMass.id() && e.values[2] == law.values[2];
        match all.iter_mut().find(|e| pulls(e) && pulls(&law)) {
            Some(gravity) => (0..2).for_each(|k| gravity.values[k] += law.values[k]),
            None => all.push(law),
        }
    }
    all
}
