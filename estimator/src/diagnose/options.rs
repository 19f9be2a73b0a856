use super::progress::Progress;
use foundation::estimate::EstimateError;
use haptics::recording::Task;
use haptics::world::World;

/// Settings of the user.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The task; inferred from sidecar and channels if absent.
    pub task: Option<Task>,
    /// Base model of a mechanism: `mass`, `mass+viscous` or `mass+viscous+coulomb`.
    pub baseline: Option<String>,
    /// The world to start from.
    pub world: Option<World>,
    /// Share done, and the wish to end.
    pub progress: Progress,
    /// True to compute [`Diagnosis::atlas`]: the part of the force's residual that every candidate alone would explain.
    pub atlas: bool,
    /// True to keep the model without any cause, for replays ([`super::twins`]).
    pub twins: bool,
}

pub(crate) fn nothing() -> EstimateError {
    EstimateError::Other("no recording was given; name at least one log".to_owned())
}
