//! Weighted regression of the tangential force on the laws, and the identifiability of their parameters.

use super::geometry::Geometry;
use super::laws::{LAWS, NAMES, Place, is_friction, missing_motion};
use super::path_coordinate::{Along, Rows};
use super::signals::Held;
use crate::identify::limits::{HELD_OUT, SIGNIFICANT};
use crate::regression::bootstrap::{Resampled, block_bootstrap};
use crate::regression::linear::LinearFit;
use crate::regression::robust::robust;
use foundation::estimate::{Correlated, EstimateError, Parameter, Quality};
use haptics::Vec2;
use haptics::recording::Recording;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Largest error of the predicted force by one parameter, as a share of the measured one; beyond, the parameter is not
/// identified.
/// Choice: halved, 3 of 43 answers change; doubled, 0 of 43 answers change.
const LARGEST_ERROR: f64 = 0.3;
/// Number of samples of each low-pass window that a shift of the geometry is followed through.
/// Choice: halved or doubled, none of 43 answers changes.
const TAPS: usize = 16;

/// Quantities besides the rows that decide the uncertainty of the laws.
pub(super) struct Sensed {
    /// Samples that turned.
    pub(super) samples: usize,
    /// Error of a force by the resolution of the log, N.
    pub(super) resolution_n: f64,
    /// Standard error of the vertical bias that was taken out, N; zero where none could be.
    pub(super) bias_error_n: f64,
    pub(super) radius_m: f64,
}

impl Sensed {
    pub(super) fn of(held: &Held, geometry: &Geometry) -> Self {
        Self {
            samples: held.turning.len(),
            resolution_n: held.resolution_n,
            bias_error_n: held.bias_error_n.unwrap_or(0.0),
            radius_m: geometry.radius_m,
        }
    }

    /// From a law's own parameter to the one in the fit: inertia is reported about the axis.
    fn scale(&self, law: usize) -> f64 {
        if law == Place::Inertia as usize { self.radius_m.powi(2) } else { 1.0 }
    }
}

/// The fitted friction laws.
pub(super) struct Friction {
    pub(super) fit: LinearFit,
    /// Indices of the fitted laws in [`LAWS`], in the order of the regressors.
    pub(super) used: Vec<usize>,
    pub(super) known: BTreeMap<usize, f64>,
    /// Error of each fitted parameter by the uncertainty of centre and give.
    pub(super) geometry_errors: Vec<f64>,
}

impl Friction {
    pub(super) fn value(&self, law: usize) -> f64 {
        let fitted = self.used.iter().position(|l| *l == law).map(|column| self.fit.values[column]);
        fitted.or_else(|| self.known.get(&law).copied()).unwrap_or(0.0)
    }

    /// True if the recording shows the parameter of a regressor: it is distinct from the others, its error is small
    /// enough, and it is not tied to one that is not shown.
    fn shown(&self, column: usize, rows: &Rows, load_n: f64) -> bool {
        /// Size of the correlation of two parameters from which they are tied.
        /// Choice: no case of the ablation reads it.
        const SAME_THING: f64 = 0.9;
        let covariance = &self.fit.covariance;
        let tied = |other: usize| {
            let scale = (covariance[(column, column)] * covariance[(other, other)]).sqrt();
            covariance[(column, other)].abs() > SAME_THING * scale
        };
        // If one kind of friction is not shown, another one near zero may only have lost its share to it.
        let doubtful = is_friction(self.used[column])
            && self.fit.t_value(column).abs() < SIGNIFICANT
            && (0..self.used.len()).any(|o| is_friction(self.used[o]) && !self.certain(o, rows, load_n));
        !doubtful
            && self.certain(column, rows, load_n)
            && (0..self.used.len()).filter(|o| *o != column).all(|o| self.certain(o, rows, load_n) || !tied(o))
    }

    fn certain(&self, column: usize, rows: &Rows, load_n: f64) -> bool {
        let regressor = &rows.columns[self.used[column]];
        self.fit.identified[column] && self.fit.std_errors[column] * size(regressor) <= LARGEST_ERROR * load_n
    }

    /// Systematic error of a regressor's parameter beside its scatter: N (or N s/m …) before it is converted into its
    /// own unit.
    fn systematic(&self, column: usize, seen: &Sensed, load_n: f64) -> f64 {
        // A force that is off by the log's resolution shifts every parameter by that share of the load.
        let resolution = self.fit.values[column].abs() * seen.resolution_n / load_n.max(1e-9);
        // A vertical bias acts just as the weight does.
        let bias = if self.used[column] == Place::Weight as usize { seen.bias_error_n } else { 0.0 };
        self.geometry_errors[column].hypot(resolution).hypot(bias)
    }

    pub(super) fn parameters(&self, seen: &Sensed, rows: &Rows) -> Vec<Parameter> {
        let samples = seen.samples;
        let load = load_n(rows);
        let resampled = self.bootstrap(rows);
        let mut parameters = Vec::new();
        for (law, name) in NAMES.into_iter().enumerate() {
            let scale = seen.scale(law);
            if let Some(known) = self.known.get(&law) {
                parameters.push(Parameter::identified("crank", name, known * scale, 0.0, 0, "stated in the sidecar"));
                continue;
            }
            let column = self.used.iter().position(|l| *l == law);
            match column {
                Some(column) if self.shown(column, rows, load) => {
                    let systematic = self.systematic(column, seen, load);
                    let error = self.fit.std_errors[column].hypot(systematic) * scale;
                    let resampled = resampled.as_ref().map(|b| b[column].hypot(systematic) * scale);
                    let how = format!("{} in the tangential force (eq. 5.2)", LAWS[law].title());
                    let value = self.fit.values[column] * scale;
                    let found = Parameter::identified("crank", name, value, error, samples, &how);
                    parameters.push(found.with_bootstrap(resampled));
                }
                _ => parameters.push(Parameter::unidentified("crank", name, samples, missing_motion(law))),
            }
        }
        parameters
    }

    /// Errors of the columns' parameters by resampling the rows.
    fn bootstrap(&self, rows: &Rows) -> Option<Resampled> {
        let (columns, rest) = system(rows, &self.used, &self.known);
        block_bootstrap(&columns, &rest, Some(&rows.weights), &self.fit)
    }

    /// Covariance of the laws' parameters.
    pub(super) fn correlated(&self, seen: &Sensed, rows: &Rows) -> Correlated {
        let load = load_n(rows);
        let scale = |column: usize| seen.scale(self.used[column]);
        let columns = 0..self.used.len();
        let entry = |i: usize, j: usize| {
            let extra = if i == j { self.systematic(i, seen, load).powi(2) } else { 0.0 };
            (self.fit.covariance[(i, j)] + extra) * scale(i) * scale(j)
        };
        let limit = |column: usize| LARGEST_ERROR * load / size(&rows.columns[self.used[column]]) * scale(column);
        Correlated {
            parameters: self.used.iter().map(|law| format!("crank.{}", NAMES[*law])).collect(),
            values: columns.clone().map(|c| self.fit.values[c] * scale(c)).collect(),
            covariance: columns.clone().map(|i| columns.clone().map(|j| entry(i, j)).collect()).collect(),
            shown_below: columns.map(limit).collect(),
        }
    }
}

fn size(values: &[f64]) -> f64 {
    (values.iter().map(|c| c * c).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Tangential force, root mean square.
fn load_n(rows: &Rows) -> f64 {
    size(&rows.tangential)
}

pub(super) fn friction(recording: &Recording, rows: &Rows) -> Result<Friction, EstimateError> {
    let known: BTreeMap<usize, f64> = NAMES
        .iter()
        .enumerate()
        .filter_map(|(law, name)| recording.meta.known.get(*name).map(|value| (law, *value)))
        .collect();
    let mut used: Vec<usize> = (0..LAWS.len()).filter(|law| !known.contains_key(law)).collect();
    let mut fit = regress(rows, &used, &known)?;
    // Laws that this recording cannot separate are left out, the least essential first; the rest keeps its meaning.
    for law in [Place::Inertia, Place::Coulomb] {
        if fit.identified.iter().all(|i| *i) {
            break;
        }
        used.retain(|l| *l != law as usize);
        fit = regress(rows, &used, &known)?;
    }
    let geometry_errors = vec![0.0; used.len()];
    Ok(Friction { fit, used, known, geometry_errors })
}

/// Change of every friction parameter when centre and give are off by one standard error each, added in quadrature.
pub(super) fn geometry_errors(
    recording: &Recording,
    held: &Held,
    geometry: &Geometry,
    friction: &Friction,
) -> Vec<f64> {
    let [ex, ey, _] = geometry.errors_m;
    let give = geometry.give_errors;
    let shifts = [
        (Vec2::new(ex, 0.0), Vec2::zeros()),
        (Vec2::new(0.0, ey), Vec2::zeros()),
        (Vec2::zeros(), Vec2::new(give.x, 0.0)),
        (Vec2::zeros(), Vec2::new(0.0, give.y)),
    ];
    // The effect of a shift is seen in a few samples of each window just as well.
    let of = |geometry: &Geometry| {
        let rows = Rows::coarse(&Along::new(recording, held, geometry), TAPS);
        regress(&rows, &friction.used, &friction.known).ok()
    };
    let mut squares = vec![0.0; friction.used.len()];
    let Some(here) = of(geometry) else { return squares };
    let shifted = |(center, give): &(Vec2, Vec2)| {
        let (center_m, give_m_per_n) = (geometry.center_m + center, geometry.give_m_per_n + give);
        of(&Geometry { center_m, give_m_per_n, ..*geometry })
    };
    for fit in shifts.par_iter().filter_map(shifted).collect::<Vec<_>>() {
        for (square, (a, b)) in squares.iter_mut().zip(fit.values.iter().zip(&here.values)) {
            *square += (a - b).powi(2);
        }
    }
    squares.into_iter().map(f64::sqrt).collect()
}

/// One weighted regression of the tangential force on the laws, robust where contacts ring.
fn regress(rows: &Rows, used: &[usize], known: &BTreeMap<usize, f64>) -> Result<LinearFit, EstimateError> {
    let (columns, rest) = system(rows, used, known);
    Ok(robust(&columns, &rest, Some(&rows.weights))?.fit)
}

/// The regressors of the wanted laws, and the tangential force less the known laws.
fn system(rows: &Rows, used: &[usize], known: &BTreeMap<usize, f64>) -> (Vec<Vec<f64>>, Vec<f64>) {
    let rest = (0..rows.len())
        .map(|i| rows.tangential[i] - known.iter().map(|(law, value)| value * rows.columns[*law][i]).sum::<f64>())
        .collect();
    (used.iter().map(|law| rows.columns[*law].clone()).collect(), rest)
}

/// Fit on the first 70 %, tested on the rest.
pub(super) fn heldout_quality(recording: &Recording, rows: &Rows) -> Option<Quality> {
    let train = 1.0 - HELD_OUT;
    let cut = (train * rows.len() as f64) as usize;
    let trained = friction(recording, &rows.head(cut)).ok()?;
    let rms = |from: usize, to: usize, model: bool| {
        let square = |i: usize| {
            let predicted: f64 = (0..LAWS.len()).map(|law| trained.value(law) * rows.columns[law][i]).sum();
            (rows.tangential[i] - if model { predicted } else { 0.0 }).powi(2)
        };
        ((from..to).map(square).sum::<f64>() / (to - from).max(1) as f64).sqrt()
    };
    let heldout_rms = rms(cut, rows.len(), true);
    Some(Quality {
        rms: rms(0, cut, true),
        heldout_rms,
        heldout_relative: heldout_rms / rms(cut, rows.len(), false).max(1e-12),
        noise: None,
        heldout_share: 1.0 - train,
        unit: "N".to_owned(),
    })
}
