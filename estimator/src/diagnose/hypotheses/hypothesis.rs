//! A physical law or a sensor fault as a hypothesis: everything that a diagnosis knows of one cause.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::dry_share::DryFriction;
use super::grid::{Near, Point, Ranges};
use super::relations::{Form, Relation};
use super::sensor_fault::SensorFault;
use super::variable::Variable;
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::regression_data::Track;
use haptics::law::{Effect, Law};

/// Everything about a cause that does not depend on data.
#[derive(Clone, Copy)]
pub(crate) struct About {
    /// Id from `docs/causes/README.md`.
    pub(crate) id: &'static str,
    /// The law of a cause that has one parameter, which is linear and positive.
    pub(crate) law: Option<&'static dyn Law>,
    /// Exact law or empirical curve, and the variables of the law.
    pub(crate) form: Form,
    /// Its relations to other causes and to the recording.
    pub(crate) relations: &'static [Relation],
    /// Variable that shows it best.
    pub(crate) seen: Variable,
}

impl About {
    /// Without a name.
    pub(crate) const PLAIN: Self =
        Self { id: "", law: None, form: Form::Exact(&[]), relations: &[], seen: Variable::Place };
}

/// Cause without regressors along one coordinate: other tests or tasks find it.
pub(crate) struct Elsewhere(pub(crate) About);

impl Hypothesis for Elsewhere {
    fn about(&self) -> About {
        self.0
    }
}

/// One cause: one file each. A task without one coordinate makes its own regressors for it.
pub(crate) trait Hypothesis: Sync {
    /// Name, law and relations.
    fn about(&self) -> About;

    /// Id from `docs/causes/README.md`.
    fn id(&self) -> &'static str {
        self.about().id
    }

    /// Searched values of the first round.
    fn coarse(&self, _ranges: &Ranges<'_>) -> Vec<Point> {
        Vec::new()
    }

    /// Searched values between those of the first round, near the candidates that were chosen.
    fn around(&self, _near: &Near<'_>) -> Vec<Point> {
        Vec::new()
    }

    /// Its candidates along one coordinate: regressors with the sign and the range that the name demands.
    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        self.about().law.map(|law| data.plain(law, &[1.0], 0).positive()).into_iter().collect()
    }

    /// Variable that shows it best. `planar`: the force has two axes, whose share along the motion depends on the
    /// position.
    fn best_seen_against(&self, _planar: bool) -> Variable {
        self.about().seen
    }

    /// Its laws in a world. Empty if no world has such a law.
    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        self.about().law.map(|law| Effect::new(law, &[found.value(0)])).into_iter().collect()
    }

    /// Widens the standard errors of its parameters by that which the rows cannot resolve.
    fn widen(&self, _parameters: &mut [CauseParameter], _track: &Track) {}

    /// Adds its estimate to a fault of the force sensors; false if it is no such fault.
    fn add_to_fault(&self, _fault: &mut SensorFault, _candidate: &Candidate, _values: &[f64]) -> bool {
        false
    }
}

/// A chosen candidate with its estimates.
pub(crate) struct Found<'a> {
    pub(crate) candidate: &'a Candidate,
    /// Estimates of its regressors.
    pub(crate) values: &'a [f64],
    /// Its searched values.
    pub(crate) searched: &'a [f64],
    pub(crate) track: &'a Track,
    /// Weight of the model, N or N m.
    pub(crate) weight_n: f64,
    /// Dry friction to which shares refer.
    pub(crate) dry: &'a DryFriction,
}

impl Found<'_> {
    /// An estimate; zero if there are fewer.
    pub(crate) fn value(&self, k: usize) -> f64 {
        self.values.get(k).copied().unwrap_or(0.0)
    }

    /// A searched value; zero if there are fewer.
    pub(crate) fn searched(&self, k: usize) -> f64 {
        self.searched.get(k).copied().unwrap_or(0.0)
    }

    /// True if its first parameter has this name.
    pub(crate) fn is_named(&self, name: &str) -> bool {
        self.candidate.linear.first().is_some_and(|(first, _)| *first == name)
    }

    /// Radius of the path; zero along a line.
    pub(crate) fn radius_m(&self) -> f64 {
        self.track.radius_m.unwrap_or(0.0)
    }
}
