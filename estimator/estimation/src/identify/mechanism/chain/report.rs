//! Report of a chain's parameters from its recordings, as a fit.

use super::solve::{FIRM, Row, Solution};
use crate::identify::limits::SIGNIFICANT;
use crate::identify::mechanism::report::EFFECT_SHARE;
use foundation::estimate::{Parameter, Quality};
use haptics::law::object::TWO_LINK;

/// The object's name in the results.
pub const OBJECT: &str = "chain";

/// Least number of recordings that show by leaving one out how far they agree.
/// Choice: no case of the ablation reads it.
pub const LEAST_FOR_JACKKNIFE: usize = 4;
/// Index of the coupling; over the second link's moment it is the length of the first link.
/// Derived: position in [`TWO_LINK`].
const COUPLING: usize = 2;
/// Index of the second link's moment.
/// Derived: position in [`TWO_LINK`].
const MOMENT: usize = 5;

/// The chosen solution with the sources of its errors.
pub struct Seen<'a> {
    /// At the cut-off that was chosen.
    pub best: &'a Solution,
    /// At the cut-offs beside it.
    pub neighbours: [&'a Solution; 2],
    /// Without each recording in turn; empty where they are too few.
    pub left_out: &'a [Solution],
}

impl Seen<'_> {
    /// Error of a quantity: its own or that between recordings, whichever is larger, and the change by the cut-off.
    fn error(&self, own: f64, of: &dyn Fn(&Solution) -> f64) -> f64 {
        let n = self.left_out.len() as f64;
        let values: Vec<f64> = self.left_out.iter().map(of).collect();
        let mean = values.iter().sum::<f64>() / n.max(1.0);
        let spread = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        let between = if n > 1.0 { ((n - 1.0) / n * spread).sqrt() } else { 0.0 };
        let best = of(self.best);
        let filter = self.neighbours.iter().map(|other| (of(other) - best).abs()).fold(0.0, f64::max);
        own.max(between).hypot(filter)
    }

    /// All numbers of the model, and the length of the first link that follows from two of them.
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut found: Vec<Parameter> = (0..TWO_LINK.len()).map(|k| self.parameter(k)).collect();
        found.push(self.elbow());
        found
    }

    fn parameter(&self, k: usize) -> Parameter {
        let (fit, name) = (&self.best.fit, TWO_LINK[k].name);
        let samples = self.best.rows.len();
        if !fit.identified[k] {
            let why =
                "the motion does not excite it apart from the others; move both joints, together and each by itself";
            return Parameter::unidentified(OBJECT, name, samples, why);
        }
        let error = self.error(fit.std_errors[k], &|s| s.fit.values[k]);
        let rms = |of: &dyn Fn(&Row) -> f64| {
            (self.best.rows.iter().map(|r| of(r).powi(2)).sum::<f64>() / samples.max(1) as f64).sqrt()
        };
        let vague = error * rms(&|r| r.columns[k]) > EFFECT_SHARE * rms(&|r| r.torque);
        if !error.is_finite() || vague && fit.values[k].abs() < SIGNIFICANT * error {
            let why = format!("it is uncertain by {error:.2e}, too much against the torques; move faster or longer");
            return Parameter::unidentified(OBJECT, name, samples, &why);
        }
        let how = format!("{}; least squares on momenta, all recordings and both joints together", TWO_LINK[k].about);
        Parameter::identified(OBJECT, name, fit.values[k], error, samples, &how)
    }

    fn elbow(&self) -> Parameter {
        const NAME: &str = "link1_length_m";
        let length = |s: &Solution| s.fit.values[COUPLING] / s.fit.values[MOMENT];
        let (fit, samples) = (&self.best.fit, self.best.rows.len());
        let value = length(self.best);
        if !(fit.identified[COUPLING] && fit.identified[MOMENT] && value.is_finite()) {
            return Parameter::unidentified(
                OBJECT,
                NAME,
                samples,
                "coupling and gravity of the second link are not shown",
            );
        }
        let [a, b] = [COUPLING, MOMENT].map(|k| fit.std_errors[k] / fit.values[k]);
        let both = fit.covariance[(COUPLING, MOMENT)] / (fit.values[COUPLING] * fit.values[MOMENT]);
        let own = value.abs() * (a * a + b * b - 2.0 * both).max(0.0).sqrt();
        let error = self.error(own, &length);
        // A quotient of two numbers of which the lower one is next to nothing is anything.
        if value <= SIGNIFICANT * error {
            let why =
                format!("it is uncertain by {error:.2e} m: gravity hardly pulls at the second link in this plane");
            return Parameter::unidentified(OBJECT, NAME, samples, &why);
        }
        let how = "coupling over the second link's gravity moment";
        Parameter::identified(OBJECT, NAME, value, error, samples, how)
    }

    /// A sentence about the filter, with how far the answers hang on it.
    pub fn how_it_was_filtered(&self) -> String {
        let change = |k: &usize| {
            let best = self.best.fit.values[*k];
            self.neighbours.iter().map(|s| (s.fit.values[*k] / best - 1.0).abs()).fold(0.0, f64::max)
        };
        let most = FIRM.iter().map(change).fold(0.0, f64::max);
        let [low, high] = self.neighbours.map(|s| s.cutoff_hz);
        let few = if self.left_out.is_empty() { "; the recordings are too few to show how far they agree" } else { "" };
        format!(
            "filtered at {:.1} Hz, where the answers change least: from {low:.1} to {high:.1} Hz inertias and moments change by up to \
             {:.1} %, which is in their errors{few}",
            self.best.cutoff_hz,
            100.0 * most
        )
    }
}

/// Quality of the model on the held-out ends of the recordings.
pub fn quality(early: &Solution, rows: &[Row], best: &Solution, held_out: f64) -> Quality {
    let root = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, n) = values.fold((0.0, 0), |(s, n), v| (s + v * v, n + 1));
        (sum / f64::from(n.max(1))).sqrt()
    };
    let late = || rows.iter().filter(|r| r.place >= 1.0 - held_out);
    let heldout_rms = root(&mut late().map(|r| r.torque - early.predicted_nm(r)));
    let torque = root(&mut late().map(|r| r.torque));
    Quality {
        rms: root(&mut best.fit.residuals.iter().copied()),
        heldout_rms,
        heldout_relative: if torque > 0.0 { heldout_rms / torque } else { f64::NAN },
        noise: None,
        heldout_share: held_out,
        unit: "Nm".to_owned(),
    }
}
