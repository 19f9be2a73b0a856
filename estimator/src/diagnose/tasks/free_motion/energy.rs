//! Losses of a free pendulum as a part of its answer.

use super::{fixed, half_swings, swings};
use crate::diagnose::answer::part::{Part, Role, Told};
use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::free_run::windows::AT_ONCE;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain::rms;
use crate::diagnose::tasks::one_coordinate;
use foundation::estimate::EstimateError;
use foundation::tasks::SystemState;
use haptics::recording::Recording;
use haptics::world::MechanismPath;

/// Comparison of the energy of a pendulum's half swings.
pub(super) struct Energy {
    track: Track,
    study: ChannelFit,
    along: Vec<bool>,
    /// Laws of the base model, which are no causes.
    of_model: Vec<&'static str>,
}

impl Told for Energy {
    fn is_cause(&self, k: usize) -> bool {
        let id = self.study.candidates[self.study.chosen[k].candidate].id;
        !self.of_model.contains(&id)
    }
}

impl Energy {
    pub(super) fn part(&self) -> Part<'_> {
        let end = rms(&self.study, &self.study.picks(), &self.along).0;
        Part {
            role: Role::Path,
            study: &self.study,
            channel: "energy of the swings",
            unit: self.track.force_unit(),
            floor: self.track.force_noise.min(end),
            noise: self.track.force_noise,
            along: &self.along,
            state: vec![Some(("force over each half swing", SystemState::FreeMotion)); self.study.target.len()],
            view: None,
            told: self,
            free_run: FreeRun::None(AT_ONCE),
            in_world: None,
        }
    }
}

/// The loss of energy of a pendulum, with gravity known by its period. `None` if nothing swings long enough.
pub(super) fn energy(
    recordings: &[Recording],
    paths: &[Option<MechanismPath>],
    (model, motion): (&Model, &Track),
    bad: &[Vec<bool>],
) -> Result<Option<Energy>, EstimateError> {
    let Some(freely) = motion.freely.filter(|_| swings(motion)) else { return Ok(None) };
    let mut tracks = Vec::new();
    for ((recording, path), bad) in recordings.iter().zip(paths).zip(bad) {
        tracks.extend(half_swings::track(recording, bad, path.as_ref(), freely)?);
    }
    // Each recording may have another zero of the angle.
    let Some(mut track) = tracks.into_iter().max_by_key(|track| track.rows.len()) else { return Ok(None) };
    let fixed = fixed(&track);
    // Each kind of friction has to show: one that drag replaces would come out negative.
    let study = one_coordinate::study(&mut track, &Model::new(), &fixed)?;
    let of_model = model.iter().map(|e| e.law().id()).collect();
    let along = vec![true; track.rows.len()];
    Ok(Some(Energy { track, study, along, of_model }))
}
