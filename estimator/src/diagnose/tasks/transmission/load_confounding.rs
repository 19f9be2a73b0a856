//! Dry friction of an input beside a load that reverses with the motion, as dry friction does.

use super::rows::Row;
use crate::diagnose::contract::Alternative;
use crate::diagnose::hypotheses::{coulomb_friction, force_gain};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::normal_equations::{Use, solve};
use foundation::signal::noise::white_noise;

/// Noise share of the load's own part from which load and dry friction count as one regressor.
const LOAD_NOISE_SHARE: f64 = 0.5;
/// Noise of the load due to the shape of its reversal, per unit of its slope over the direction.
const SHAPE: f64 = 0.03;
/// Least mean square of the load's own part, to avoid division by zero.
const LEAST_OWN_MEAN_SQUARE: f64 = 1e-6;

/// Separability of a load from dry friction.
pub struct Told {
    /// Share of the load's own part (beyond the other regressors) that may be noise or another shape of the reversal, 0
    /// to 1.
    noise: f64,
    /// Load per unit of direction, N or N m.
    slope: f64,
    /// Coefficient of the load in the comparison, in units of force per unit of load.
    weight: f64,
}

impl Told {
    /// Separability in a comparison whose base model has the load as regressor `load`. `direction`: the regressor of
    /// dry friction, a value per row.
    pub fn of(study: &ChannelFit, load: usize, direction: &[f64], rows: &[Row]) -> Option<Self> {
        let used: Vec<usize> = (0..rows.len())
            .filter(|i| study.layout.weight[*i] > 0.0 && !matches!(study.system.uses[*i], Use::Locked(_)))
            .collect();
        let others = study.base.iter().enumerate().filter(|(k, _)| *k != load).map(|(_, column)| column.as_slice());
        let columns: Vec<&[f64]> = others.chain([direction, study.base[load].as_slice()]).collect();
        let gram = nalgebra::DMatrix::from_fn(columns.len(), columns.len(), |a, b| {
            used.iter().map(|i| columns[a][*i] * columns[b][*i]).sum::<f64>()
        });
        let beside: Vec<usize> = (0..columns.len() - 1).collect();
        let solved = solve(&gram, &beside, columns.len() - 1)?;
        let loads: Vec<f64> = rows.iter().map(|r| r.load.unwrap_or(0.0)).collect();
        let own = (solved.rss / used.len().max(1) as f64).max(LEAST_OWN_MEAN_SQUARE * f64::MIN_POSITIVE);
        let weight = *study.solved.as_ref()?.values.get(load)?;
        let slope = *solved.values.last()?;
        let noise = ((white_noise(&loads).powi(2) + (SHAPE * slope).powi(2)) / own).min(1.0);
        Some(Self { noise, slope, weight })
    }

    /// True if load and dry friction are equivalent in this recording.
    pub fn is_one(&self) -> bool {
        self.noise > LOAD_NOISE_SHARE
    }

    /// Error of this dry friction due to the load, N or N m. Noise of a regressor biases its coefficient towards zero,
    /// and dry friction takes over the missing part. If the two are equivalent, all that reverses with the direction
    /// may belong to either.
    pub fn error(&self, friction: f64) -> f64 {
        let shared = self.weight * self.slope;
        if self.is_one() { (friction + shared).abs() } else { (shared * self.noise / (1.0 - self.noise)).abs() }
    }

    /// Alternative explanation of that friction by the load.
    pub fn alternative(&self) -> Option<Alternative> {
        self.is_one().then(|| Alternative {
            id: force_gain::ID.to_owned(),
            instead_of: coulomb_friction::ID.to_owned(),
            posterior: 0.5,
            why: WHY.to_owned(),
        })
    }
}

/// Why friction cannot be told from the load.
pub const WHY: &str = "the load at the output turns round with the motion, as dry friction does: with another gain of its sensor, or another \
     lever, it makes the same force; record runs under other loads";
