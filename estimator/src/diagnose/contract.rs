//! Published answer of a diagnosis. These types *are* the JSON of `touchstone diagnose --json`.

use foundation::tasks::SystemState;
use haptics::law::Kind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A parameter of a cause.
pub fn parameter(name: &str, value: f64, std_error: f64, unit: &str) -> CauseParameter {
    CauseParameter { name: name.to_owned(), value, std_error, unit: unit.to_owned() }
}

/// The answer in one word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Something beyond the model is there, and it has a name.
    Causes,
    /// Nothing beyond the noise.
    #[default]
    None,
    /// Two or more causes explain the recording equally well.
    Ambiguous,
    /// Something is there that no known law explains.
    Unexplained,
}

/// The model that was started from.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Baseline {
    /// Its terms, e.g. `weight+load-friction+viscous-friction`.
    pub model: String,
    /// Root mean square of the force that it leaves unexplained where it was fitted, N (N m for angles).
    #[serde(rename = "rms_N")]
    pub rms_n: f64,
    /// The same on the blocks that took part in nothing.
    #[serde(rename = "heldout_rms_N")]
    pub heldout_rms_n: f64,
    /// Both once more by their unit's name, where they are torques.
    #[serde(rename = "rms_Nm", default, skip_serializing_if = "Option::is_none")]
    pub rms_nm: Option<f64>,
    #[serde(rename = "heldout_rms_Nm", default, skip_serializing_if = "Option::is_none")]
    #[allow(missing_docs)] // said above
    pub heldout_rms_nm: Option<f64>,
    /// Probability of residuals at least so correlated if they were white (Ljung & Box 1978).
    pub whiteness_p: f64,
    /// Which channel these figures, the noise floor and the final ones are of, where there are several, …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// … and their unit; nothing where nothing was compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
}

/// A parameter of a cause.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct CauseParameter {
    /// As in the law's page of the catalogue.
    pub name: String,
    /// Estimate.
    pub value: f64,
    /// One standard error.
    pub std_error: f64,
    /// Unit of both.
    pub unit: String,
}

/// What an extension is worth on data that took part in nothing.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Gain {
    /// What is unexplained without the cause (all others in): force, or what `unit` says.
    pub heldout_rms_before: f64,
    /// … and with it.
    pub heldout_rms_after: f64,
    /// Part of what could be explained (the difference to the noise floor, in squares) that it explains.
    pub share_of_explainable: f64,
    /// 95 % interval of that share, by a block bootstrap.
    pub interval: [f64; 2],
    /// Why there is no share, where share and interval are 0 for that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_share: Option<String>,
    /// True where too few rows were there to keep any out of the choice: each was then left out of the fit in turn, but not of the choice.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub in_turn: bool,
    /// Unit of what is unexplained; nothing where nothing was held out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// What it is worth when the model runs on its own over short windows, where that could be done.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rollout: Option<Rollout>,
    /// Why it was not run forward, where there is no rollout for a reason.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_rollout: Option<String>,
}

impl Gain {
    /// With what running forward says, or why it was not done.
    pub(crate) fn run(self, forward: Result<Rollout, String>) -> Self {
        let (rollout, no_rollout) = forward.map_or_else(|why| (None, Some(why)), |rollout| (Some(rollout), None));
        Self { rollout, no_rollout, ..self }
    }
}

/// What a rollout is compared by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RolloutOf {
    /// The position, under the measured force.
    Position,
    /// The force of a hand that holds on, beside the measured one.
    Force,
}

/// Error of a model that runs forward in time from the measured state, over windows of data that were not fitted.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Rollout {
    /// What is compared.
    pub of: RolloutOf,
    /// m or rad of a position, N or N m of a force.
    pub unit: String,
    /// Longest window, s; the state is the measured one at the start of each.
    pub window_s: f64,
    /// How many there were.
    pub windows: usize,
    /// Root mean square error without the cause (all others in) …
    pub rms_before: f64,
    /// … and with it.
    pub rms_after: f64,
    /// Part of the error's power that it takes off.
    pub share: f64,
    /// 95 % interval of that share, by a bootstrap over windows.
    pub interval: [f64; 2],
    /// True where no window took part in nothing: each was then left out of the fit in turn, but not of the choice.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub in_turn: bool,
}

/// A cause that was found.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Cause {
    /// Out of `docs/causes/README.md`, or `other:<expression>`.
    pub id: String,
    /// Plant or instrument.
    pub kind: Kind,
    /// What it comes out at.
    pub parameters: Vec<CauseParameter>,
    /// Probability of such a gain by chance, corrected for the number of causes that were tried.
    pub p_value: f64,
    /// Probability among the causes that could stand in its place.
    pub posterior: f64,
    /// Evidence against structured errors in its place; nothing for faults of samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standing: Option<Standing>,
    /// What it is worth.
    pub gain: Gain,
    /// One sentence: what in the residual shows it.
    pub evidence: String,
}

/// Evidence of a cause against structured errors that no law describes.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Standing {
    /// Logarithm of the Bayes factor of the best model with the cause over the best one without it, in which structured
    /// errors may take its place.
    pub ln_bayes_factor: f64,
    /// Power of the cause as a share of its own and that of the structured errors beside it.
    pub share: f64,
    /// Evidence on rows that took no part in the choice and the fit, 2 ln(likelihood).
    pub held_out_evidence: f64,
}

/// Structured force (of other channels: length, speed) that is there and that no law of the catalogue describes.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct ModelError {
    /// Root mean square, in the unit of the baseline's figures.
    #[serde(rename = "rms_N")]
    pub rms_n: f64,
    /// The same by its unit's name, if that is a torque.
    #[serde(rename = "rms_Nm", default, skip_serializing_if = "Option::is_none")]
    pub rms_nm: Option<f64>,
    /// Evidence of all of it together, ln(likelihood) less the penalty.
    pub evidence: f64,
    /// Share of the power that the base model leaves beyond the noise.
    pub share: f64,
    /// Variables that it goes with, the largest part first.
    pub over: Vec<OverVariable>,
}

/// Part of a model error that is a function of one variable.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct OverVariable {
    /// Name of the variable.
    pub variable: String,
    /// Root mean square.
    #[serde(rename = "rms_N")]
    pub rms_n: f64,
    /// The same by its unit's name, if that is a torque.
    #[serde(rename = "rms_Nm", default, skip_serializing_if = "Option::is_none")]
    pub rms_nm: Option<f64>,
}

/// A cause that would explain the recording as well.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Alternative {
    /// Out of `docs/causes/README.md`.
    pub id: String,
    /// The found cause whose place it could take.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub instead_of: String,
    /// Probability among the causes that could stand there.
    pub posterior: f64,
    /// Why they cannot be told apart here.
    pub why: String,
}

/// A cause that this recording could not have shown.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct NotExcited {
    /// Out of `docs/causes/README.md`.
    pub id: String,
    /// What is missing.
    pub why: String,
}

impl NotExcited {
    pub(crate) fn new(id: &str, why: &str) -> Self {
        Self { id: id.to_owned(), why: why.to_owned() }
    }
}

/// A cause that was looked for and not named.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PassedOver {
    /// Out of `docs/causes/README.md`.
    pub id: String,
    /// Its score on the model alone, in units of 2 ln(likelihood), what its parameters cost paid; 0 where it is impossible.
    pub alone: f64,
    /// Its score beside what was found.
    pub beside: f64,
    /// The score that names a cause.
    pub least: f64,
    /// Why it was not named.
    pub why: String,
}

/// The recording that would settle what is open.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct NextExperiment {
    /// What to do, in words.
    pub motion: String,
    /// What it tells apart.
    pub separates: Vec<String>,
    /// Probability that it does.
    pub expected_power: f64,
    /// The same for an operator that is a program; nothing where the library has words only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub experiment: Option<Experiment>,
}

impl NextExperiment {
    /// Experiment in words alone.
    pub(crate) fn in_words(motion: &str, separates: Vec<String>, expected_power: f64) -> Self {
        Self { motion: motion.to_owned(), separates, expected_power, experiment: None }
    }

    /// The same for the first open question, with all alternatives to its cause.
    pub(crate) fn of_first(open: &[Alternative], motion: &str, expected_power: f64) -> Option<Self> {
        let cause = &open.first()?.instead_of;
        let rivals = open.iter().filter(|a| a.instead_of == *cause).map(|a| a.id.clone());
        Some(Self::in_words(motion, std::iter::once(cause.clone()).chain(rivals).collect(), expected_power))
    }
}

/// A motion of the library, for an operator that is a program. Lengths are m, angles rad: as the coordinate is (a crank's is its angle).
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Experiment {
    /// Which motion: `sweep-across`, `sweep-let-go`, `short-strokes`, `bursts`, `one-way`, `rests-and-squeezes`, `long-mixed`,
    /// `hang-weight`, `carry-let-go`, `carry-still`, `slide-let-go`, `pierce-slow-fast` or `throw-slow-fast`; `docs/diagnosis.md` says what
    /// each is.
    pub id: String,
    /// How long the object is held, s.
    pub seconds: f64,
    /// How long nothing is touched before and after, s.
    pub free_s: f64,
    /// The coordinate in the middle of the motion.
    pub middle: f64,
    /// How far it goes to either side.
    pub half_range: f64,
    /// Its fastest speed, a second.
    pub fast: f64,
    /// Size of the push and pull across the motion, N; 0 where there is none.
    #[serde(rename = "across_N")]
    pub across_n: f64,
    /// Weight to hang on, N; 0 where none is.
    #[serde(rename = "added_weight_N")]
    pub added_weight_n: f64,
    /// Distance from the axis at which it is hung on, m: the radius of a crank.
    pub added_lever_m: f64,
}

/// What the found laws are worth on a recording that took part in nothing.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Validation {
    /// Unexplained force by the model alone, as fitted, N or N m; of tasks without one coordinate what is left of a channel.
    pub rms_before: f64,
    /// … and with what was found.
    pub rms_after: f64,
    /// Part of the power that the model leaves which goes with what was found; below zero where it makes more of it …
    #[serde(default)]
    pub share: f64,
    /// … and its 95 % interval, by a bootstrap over pieces of the recording.
    #[serde(default)]
    pub interval: [f64; 2],
    /// Which channel, where there are several, …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// … and its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Causes that belong to the first recordings alone (a time, an insertion), or that this one cannot show.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
}

/// A question that an earlier recording left open and a later one answered.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Settled {
    /// Name of the recording that settled it.
    pub by: String,
    /// What it could have been, …
    pub excluded: String,
    /// … instead of this, which stays.
    pub kept: String,
    /// In one sentence.
    pub why: String,
}

/// How well the extended model does in the end.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Final {
    /// Unexplained force on the blocks that took part in nothing, N or N m.
    #[serde(rename = "heldout_rms_N")]
    pub heldout_rms_n: f64,
    /// The same by its unit's name, where it is a torque.
    #[serde(rename = "heldout_rms_Nm", default, skip_serializing_if = "Option::is_none")]
    pub heldout_rms_nm: Option<f64>,
    /// As in [`Baseline::whiteness_p`].
    pub whiteness_p: f64,
}

/// Everything that a diagnosis found.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Diagnosis {
    /// The answer in one word.
    pub verdict: Verdict,
    /// Where it started.
    pub baseline: Baseline,
    /// Noise of the force, N or N m, from where nothing touches, or from what is too fast to be mechanical.
    #[serde(rename = "noise_floor_N")]
    pub noise_floor_n: f64,
    /// The same by its unit's name, where it is a torque.
    #[serde(rename = "noise_floor_Nm", default, skip_serializing_if = "Option::is_none")]
    pub noise_floor_nm: Option<f64>,
    /// What the model leaves in every channel and state, without and with what was found, beside the noise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub residuals: Vec<Residual>,
    /// Strongest first.
    pub causes: Vec<Cause>,
    /// What else it could be.
    pub alternatives: Vec<Alternative>,
    /// What this recording could not have shown.
    pub not_excited: Vec<NotExcited>,
    /// Structured force that no law of the catalogue describes; nothing if the rows show none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model_error: Option<ModelError>,
    /// What was looked for and not named, and why.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub passed_over: Vec<PassedOver>,
    /// What to record next; nothing when nothing is open.
    pub next_experiment: Option<NextExperiment>,
    /// Where it ended.
    #[serde(rename = "final")]
    pub end: Final,
    /// Sentences, most important first.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// One a recording of `--validate`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub validation: Vec<Validation>,
    /// Questions of earlier recordings that later ones answered.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub settled: Vec<Settled>,
    /// Replays without any cause, if `--twin` asks for them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub twins: Option<Box<Twins>>,
}

/// Replays of the recordings without any cause: their own motion, with structured errors and noise as large as these
/// recordings show.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Twins {
    /// Number of replays.
    pub runs: usize,
    /// Number of replays in which a cause is certain, which is then false.
    pub named: usize,
    /// 95 % interval of their share (Clopper & Pearson 1934).
    pub interval: [f64; 2],
    /// The false causes, the most frequent first.
    pub by_cause: Vec<NamedInTwins>,
    /// Median of the base model's held-out residual in the replays: comparable with that of the recordings if they have
    /// as much structure and noise.
    #[serde(rename = "heldout_rms_N")]
    pub heldout_rms_n: f64,
    /// The same by its unit's name, if that is a torque.
    #[serde(rename = "heldout_rms_Nm", default, skip_serializing_if = "Option::is_none")]
    pub heldout_rms_nm: Option<f64>,
}

/// A false cause in replays.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct NamedInTwins {
    /// Its name in `docs/causes/README.md`.
    pub id: String,
    /// Number of replays in which it is certain.
    pub runs: usize,
}

/// Probability from which a cause is certain.
/// Derived: the level of all confidence intervals.
pub(crate) const CERTAIN_FROM: f64 = 0.95;

/// True if a cause, or one of the alternatives to it, is certainly there.
pub fn is_certain(cause: &Cause, alternatives: &[Alternative]) -> bool {
    let instead = alternatives.iter().filter(|a| a.instead_of == cause.id).map(|a| a.posterior);
    // A sum of shares may be rounded.
    cause.posterior + instead.sum::<f64>() >= CERTAIN_FROM - 1e-9
}

impl Diagnosis {
    /// Causes that are certain, or whose alternatives and they are together.
    pub fn certain(&self) -> Vec<&Cause> {
        self.causes.iter().filter(|c| is_certain(c, &self.alternatives)).collect()
    }

    /// Repeats the figures of a torque in N m under the names with that unit.
    pub fn name_by_unit(&mut self) {
        if self.baseline.unit.as_deref() == Some("N m") {
            self.baseline.rms_nm = Some(self.baseline.rms_n);
            self.baseline.heldout_rms_nm = Some(self.baseline.heldout_rms_n);
            self.noise_floor_nm = Some(self.noise_floor_n);
            self.end.heldout_rms_nm = Some(self.end.heldout_rms_n);
            if let Some(error) = &mut self.model_error {
                error.rms_nm = Some(error.rms_n);
                error.over.iter_mut().for_each(|o| o.rms_nm = Some(o.rms_n));
            }
            if let Some(twins) = &mut self.twins {
                twins.heldout_rms_nm = Some(twins.heldout_rms_n);
            }
        }
    }
}

/// What is left of one channel in one state.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Residual {
    /// What was compared, in words.
    pub channel: String,
    /// Unit of the figures.
    pub unit: String,
    /// The state that the rows are in.
    pub state: SystemState,
    /// Rows of the comparison in that state.
    pub rows: usize,
    /// Root mean square that the model leaves, each row as far as it is trusted …
    pub rms_before: f64,
    /// … and what the model leaves with all that was found.
    pub rms_after: f64,
    /// Noise of a row; absent where nothing tells it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_floor: Option<f64>,
}
