//! The list of all hypotheses, and the library of candidates that they make together.

use super::axis_sign::AXIS_SIGN;
use super::candidate::Candidate;
use super::channel_fault::CHANNEL_FAULT;
use super::dictionary::Dictionary;
use super::fingertip_slip::FINGERTIP_SLIP;
use super::force_cross_axis::ForceCrossAxis;
use super::force_gain::ForceGain;
use super::force_saturation::FORCE_SATURATION;
use super::grid::{Grid, Near, Ranges};
use super::hypothesis::Hypothesis;
use super::joint_offset::JOINT_OFFSET;
use super::length_scale::LENGTH_SCALE;
use super::pad_compliance::PAD_COMPLIANCE;
use super::regressor_cache::Columns;
use super::relations::{Form, Relation};
use super::sensor_fault::SensorFault;
use super::stiffness_hardening::STIFFNESS_HARDENING;
use super::time_delay::TimeDelay;
use super::variable::Variable;
use super::velocity_loss::VELOCITY_LOSS;
use super::{
    added_constraint, backlash, coulomb_friction, eccentric_mass, force_gain, friction_asymmetry, friction_change,
    gravity_tilt, hysteresis, inertia, load_friction, local_resistance, mass_change, position_ripple, quadratic_drag,
    return_spring, stribeck, time_delay, viscous_friction,
};
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::regression_data::{Row, Track};
use std::sync::LazyLock;

macro_rules! of_laws {
    (causes { $($cause_file:ident: $cause:ident,)* } models { $($model_file:ident: $model:ident,)* }) => {
        /// Hypotheses of laws of a coordinate.
        static OF_LAWS: &[&dyn Hypothesis] = &[$(&haptics::law::$cause),*];
    };
}

haptics::laws!(of_laws);

/// Hypotheses of faults of the measurement and of contacts.
static OF_OTHERS: [&dyn Hypothesis; 12] = [
    &TimeDelay,
    &ForceGain,
    &ForceCrossAxis,
    &FORCE_SATURATION,
    &CHANNEL_FAULT,
    &AXIS_SIGN,
    &JOINT_OFFSET,
    &LENGTH_SCALE,
    &PAD_COMPLIANCE,
    &STIFFNESS_HARDENING,
    &FINGERTIP_SLIP,
    &VELOCITY_LOSS,
];

/// Causes whose candidates come before those of all others, in this order: of two equally good ones the first is chosen.
const FIRST: [&str; 19] = [
    coulomb_friction::ID,
    viscous_friction::ID,
    load_friction::ID,
    friction_asymmetry::ID,
    stribeck::ID,
    quadratic_drag::ID,
    inertia::ID,
    time_delay::ID,
    eccentric_mass::ID,
    gravity_tilt::ID,
    position_ripple::ID,
    return_spring::ID,
    local_resistance::ID,
    added_constraint::ID,
    hysteresis::ID,
    backlash::ID,
    mass_change::ID,
    friction_change::ID,
    force_gain::ID,
];

/// All hypotheses: those of [`FIRST`], then laws in the order of their list, then the others.
static ALL: LazyLock<Vec<&dyn Hypothesis>> = LazyLock::new(|| {
    let mut all: Vec<&dyn Hypothesis> = OF_LAWS.iter().chain(&OF_OTHERS).copied().collect();
    all.sort_by_key(|hypothesis| FIRST.iter().position(|id| *id == hypothesis.id()).unwrap_or(FIRST.len()));
    all
});

/// The hypothesis of a cause; none for a regressor of the base model or a cause without a law.
pub(crate) fn hypothesis(id: &str) -> Option<&'static dyn Hypothesis> {
    ALL.iter().copied().find(|hypothesis| hypothesis.id() == id)
}

/// Exactness and variables of a cause's law.
pub(crate) fn form(id: &str) -> Form {
    hypothesis(id).map_or(Form::Exact(&[]), |h| h.about().form)
}

/// Relations of a cause.
pub(crate) fn relations(id: &str) -> &'static [Relation] {
    hypothesis(id).map_or(&[], |h| h.about().relations)
}

/// Variable that shows a cause best along one coordinate.
pub(crate) fn best_seen_against(id: &str, planar: bool) -> Variable {
    hypothesis(id).map_or(Variable::Place, |hypothesis| hypothesis.best_seen_against(planar))
}

/// Widens the standard errors of a cause's parameters by that which the rows cannot resolve.
pub(crate) fn widen(id: &str, parameters: &mut [CauseParameter], track: &Track) {
    if let Some(hypothesis) = hypothesis(id) {
        hypothesis.widen(parameters, track);
    }
}

/// Adds a candidate's estimate to a fault of the force sensors; false if it is no such fault.
pub(crate) fn add_to_fault(fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
    hypothesis(candidate.id).is_some_and(|hypothesis| hypothesis.add_to_fault(fault, candidate, values))
}

/// True if the first value of a candidate is a share of the model's dry friction.
pub(crate) fn is_share(candidate: &Candidate) -> bool {
    relations(candidate.id).contains(&Relation::ShareOfDryFriction)
        && candidate.linear.first().is_some_and(|(_, unit)| *unit == "1")
}

/// Pairs of causes with the same regressor for every motion, and the reason in words.
pub(crate) fn twins() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    ALL.iter().flat_map(|hypothesis| {
        hypothesis.about().relations.iter().filter_map(|relation| match relation {
            Relation::SameAs(other, why) => Some((hypothesis.id(), *other, *why)),
            _ => None,
        })
    })
}

/// Causes that a one-way motion that slows down cannot show.
pub(crate) fn with_both_ways() -> impl Iterator<Item = &'static str> {
    let needs = |hypothesis: &&&dyn Hypothesis| hypothesis.about().relations.contains(&Relation::NeedsBothWays);
    ALL.iter().filter(needs).map(|hypothesis| hypothesis.id())
}

/// True if a free motion can show a cause at all. `both_ways`: the motion has both directions.
pub(crate) fn can_show(id: &str, both_ways: bool) -> bool {
    let relations = relations(id);
    !relations.contains(&Relation::NeedsForce) && (both_ways || !relations.contains(&Relation::NeedsBothWays))
}

impl Grid {
    /// Grid of the first round.
    pub fn coarse(track: &Track) -> Self {
        let ranges = Ranges::of(track);
        let mut grid = Self::empty(&ranges);
        for hypothesis in ALL.iter() {
            grid.add(hypothesis.id(), hypothesis.coarse(&ranges));
        }
        grid
    }

    /// Values between those of the coarse grid, around the ones found; `step`: distance from them, 1 at first.
    pub fn around(found: &[&Candidate], track: &Track, step: f64) -> Self {
        let found = found.iter().map(|candidate| (*candidate, relations(candidate.id))).collect();
        let near = Near { ranges: Ranges::of(track), found, step };
        let mut grid = Self::empty(&near.ranges);
        for hypothesis in ALL.iter() {
            grid.add(hypothesis.id(), hypothesis.around(&near));
        }
        grid
    }
}

/// All candidates of the coarse grid on a track with this predicted force, all of which may resist. `fixed`, `without`:
/// as in the [`Dictionary`].
pub(crate) fn coarse_candidates(
    track: &Track,
    predicted: &[f64],
    fixed: &[Vec<f64>],
    without: &[&str],
) -> Vec<Candidate> {
    // Dry friction at each row if it slid in the positive direction.
    let slid = |(r, f): (&Row, &f64)| {
        if r.motion.direction.abs() > 0.05 { f / r.motion.direction } else { f.abs() }
    };
    let dry: Vec<f64> = track.rows.iter().zip(predicted).map(slid).collect();
    let (grid, columns) = (&Grid::coarse(track), &Columns::default());
    Dictionary { track, predicted, resisting: predicted, dry: &dry, fixed, without, grid, columns }.candidates()
}

impl Dictionary<'_> {
    /// All candidates.
    pub fn candidates(&self) -> Vec<Candidate> {
        let mut all: Vec<Candidate> = ALL.iter().flat_map(|hypothesis| hypothesis.candidates(self)).collect();
        all.retain(|c| !self.without.contains(&c.id));
        if self.track.freely.is_some() {
            let both_ways = !self.track.goes_one_way();
            all.retain(|c| can_show(c.id, both_ways));
        }
        all.retain(|c| c.regressors.iter().all(|v| v.iter().all(|x| x.is_finite()) && v.iter().any(|x| *x != 0.0)));
        all
    }

    /// Only the candidates that have searched values.
    pub fn searched(&self) -> Vec<Candidate> {
        let mut all = self.candidates();
        all.retain(|c| !c.searched.is_empty());
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::law::causes;

    #[test]
    fn every_cause_of_the_catalogue_has_one_hypothesis() {
        let mut of_catalogue: Vec<&str> = causes().map(|entry| entry.id).collect();
        let mut own: Vec<&str> = ALL.iter().map(|hypothesis| hypothesis.id()).collect();
        of_catalogue.sort_unstable();
        own.sort_unstable();
        assert_eq!(own, of_catalogue);
    }
}
