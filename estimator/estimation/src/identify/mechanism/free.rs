//! Motion without a force column: nothing drives the mechanism, so only the ratios of its parameters are identifiable.
//! One known parameter sets the scale of all.

use super::parameters::{CLOCK_TOLERANCE, Known, Term};
use super::regress::{System, shown};
use super::report::{OBJECT, PHASE, push_known};
use super::signals::{Piece, Raw};
use crate::identify::limits::{CLEARLY_SIGNIFICANT, SIGNIFICANT};
use crate::regression::bootstrap::block_bootstrap;
use crate::regression::linear::{LinearFit, least_squares};
use foundation::estimate::{EstimateError, Fit, Parameter};
use haptics::law::Coordinate;
use haptics::recording::Meta;

/// Relative error of the integration that the refinement rests on.
/// Choice: no case of the ablation reads it.
const INTEGRATION_ERROR: f64 = 2e-5;
/// Ratios that are reported without a known scale.
const RATIO_NAMES: [(Term, &str, &str); 4] = [
    (Term::Viscous, "viscous_per_inertia_1_s", "viscous_per_mass_1_s"),
    (Term::Coulomb, "coulomb_per_inertia_rad_s2", "coulomb_per_mass_m_s2"),
    (Term::Offset, "offset_per_inertia_rad_s2", "offset_per_mass_m_s2"),
    (Term::GravitySine, "gravity_moment_per_inertia_rad_s2", "gravity_per_mass_m_s2"),
];

/// Ratios of the terms to the inertia: −acceleration = Σ ratio × regressor.
struct Ratios {
    terms: Vec<Term>,
    fit: LinearFit,
    /// Errors by resampling, in the order of the terms.
    drawn: Option<Vec<f64>>,
}

impl Ratios {
    fn get(&self, term: Term) -> Option<(f64, f64)> {
        let i = self.terms.iter().position(|t| *t == term)?;
        let value = self.fit.values[i];
        let by_clock = value * CLOCK_TOLERANCE * term.powers_of_time();
        self.fit.identified[i].then(|| (value, self.fit.std_errors[i].hypot(by_clock)))
    }

    /// The same ratios with the errors by resampling in place of those by covariance.
    fn resampled(mut self) -> Option<Self> {
        self.fit.std_errors = self.drawn.take()?;
        Some(self)
    }
}

/// A known parameter that sets the scale of all of a free motion's values: its value in SI units, for a gravity moment
/// the whole of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stated {
    /// Mass or moment of inertia, kg or kg m².
    Inertia(f64),
    /// Gravity moment, N m.
    Gravity(f64),
    /// Viscous friction, N s/m or N m s.
    Viscous(f64),
    /// Coulomb friction, N or N m.
    Coulomb(f64),
}

/// Parameters stated in a sidecar that set the scale of a free motion, the most informative first.
pub fn stated(meta: &Meta, coordinate: Coordinate) -> Vec<Stated> {
    let known = Known::from_meta(meta, coordinate);
    let moment = known.value(Term::GravitySine).map(|a| a.hypot(known.value(Term::GravityCosine).unwrap_or(0.0)));
    let all = [
        known.value(Term::Inertia).map(Stated::Inertia),
        moment.map(Stated::Gravity),
        known.value(Term::Viscous).map(Stated::Viscous),
        known.value(Term::Coulomb).map(Stated::Coulomb),
    ];
    all.into_iter().flatten().collect()
}

/// Fits a free motion. The acceleration carries the most noise, so it is the left-hand side and not a regressor.
pub fn fit(raws: &[Raw], pieces: &[Piece], known: &Known) -> Result<Fit, EstimateError> {
    let coordinate = raws[0].coordinate;
    let samples = pieces.iter().map(|p| p.usable.iter().filter(|u| **u).count()).sum();
    let mut ratios = ratios(pieces, known, coordinate)?;
    if ratios.fit.identified.iter().all(|i| *i)
        && let Some(refined) = super::pendulum::refine(raws, pieces, &ratios.terms, &ratios.fit.values)
    {
        (ratios.fit, ratios.drawn) = refined;
    }
    let mut result = report(&ratios, known, coordinate, samples);
    if let Some(resampled) = ratios.resampled() {
        // The errors go the same way through everything that is made of the ratios.
        let drawn = report(&resampled, known, coordinate, samples).parameters;
        let taken = std::mem::take(&mut result.parameters).into_iter().zip(drawn);
        result.parameters = taken.map(|(p, d)| if p.samples > 0 { p.with_bootstrap(d.std_error) } else { p }).collect();
    }
    Ok(result)
}

fn report(ratios: &Ratios, known: &Known, coordinate: Coordinate, samples: usize) -> Fit {
    let mut result = Fit { task: "mechanism".to_owned(), ..Fit::default() };
    let scale = scale(ratios, known);
    let Some((inertia, relative_error)) = scale else {
        unscaled(&mut result, ratios, coordinate, samples);
        return result;
    };
    let name = |t: Term| t.name(coordinate);
    if known.value(Term::Inertia).is_none() {
        let how = "free motion: the known gravity moment over the measured ratio of the two";
        let value = Parameter::identified(OBJECT, name(Term::Inertia), inertia, inertia * relative_error, samples, how);
        result.parameters.push(value);
    }
    for term in [Term::Viscous, Term::Coulomb] {
        let Some((ratio, error)) = ratios.get(term) else {
            let why = "the free motion does not show it apart from the other terms";
            result.parameters.push(Parameter::unidentified(OBJECT, name(term), samples, why));
            continue;
        };
        let (value, error) = (ratio * inertia, inertia * error.hypot(ratio * relative_error));
        let how = "free motion: ratio to the inertia, which the known parameter gives its size";
        result.parameters.push(Parameter::identified(OBJECT, name(term), value, error, samples, how));
    }
    resistance(&mut result, ratios, coordinate, (inertia, relative_error), samples);
    gravity(&mut result, ratios, known, inertia, relative_error, samples);
    push_known(&mut result, known, coordinate);
    result.warnings.push(
        "there is no force column: the mechanism is taken to move freely, and every value rests on what the sidecar calls known"
            .to_owned(),
    );
    result
}

/// Sum of friction and constant force of a one-way coasting motion, which does not separate them: it is still worth
/// knowing.
fn resistance(result: &mut Fit, ratios: &Ratios, coordinate: Coordinate, inertia: (f64, f64), samples: usize) {
    let offset = ratios.terms.iter().position(|t| *t == Term::Offset);
    let Some(i) = offset.filter(|_| !ratios.terms.contains(&Term::Coulomb)) else { return };
    let (ratio, by_clock) = (ratios.fit.values[i], CLOCK_TOLERANCE * Term::Offset.powers_of_time());
    let error = inertia.0 * ratios.fit.std_errors[i].hypot(ratio * by_clock).hypot(ratio * inertia.1);
    if !error.is_finite() {
        return;
    }
    let name = if coordinate == Coordinate::Linear { "resistance_N" } else { "resistance_Nm" };
    let how = "free motion: all constant resistance along +coordinate together, which this motion cannot split";
    result.parameters.push(Parameter::identified(OBJECT, name, ratio * inertia.0, error, samples, how));
}

/// The regression −a = Σ ratio × regressor over all segments.
fn ratios(pieces: &[Piece], known: &Known, coordinate: Coordinate) -> Result<Ratios, EstimateError> {
    let mut candidates = vec![Term::Viscous, Term::Coulomb];
    let swings = known.value(Term::GravitySine).is_some() || coordinate == Coordinate::Angular && restoring(pieces);
    if swings {
        candidates.extend([Term::GravitySine, Term::GravityCosine]);
    } else {
        candidates.push(Term::Offset);
    }
    let seen = shown(pieces, &Known::default(), &candidates, Term::Offset);
    let minus_acceleration = |p: &Piece| -> Vec<f64> { p.motion.iter().map(|m| -m.acceleration).collect() };
    let system = System::stack(pieces, &seen.fitted, &Known::default(), minus_acceleration);
    let mut fit = system.solve()?;
    for (i, term) in system.terms.iter().enumerate() {
        if seen.hidden.iter().any(|(t, _)| t == term) {
            fit.identified[i] = false;
        }
    }
    let weights = system.weights(&fit);
    let drawn = block_bootstrap(&system.columns, &system.target, weights.as_deref(), &fit);
    Ok(Ratios { terms: system.terms, fit, drawn: drawn.map(|drawn| drawn.errors().to_vec()) })
}

/// True when the acceleration points back to a rest position: worth asking for gravity.
fn restoring(pieces: &[Piece]) -> bool {
    let usable = |p: &Piece| -> Vec<(f64, f64)> {
        let all = p.motion.iter().zip(&p.usable).filter(|(_, u)| **u);
        all.map(|(m, _)| (m.position.sin(), m.acceleration)).collect()
    };
    let pairs: Vec<(f64, f64)> = pieces.iter().flat_map(usable).collect();
    let (sine, acceleration): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
    least_squares(&[sine.clone(), vec![1.0; sine.len()]], &acceleration, None)
        .is_ok_and(|f| f.t_value(0) < -CLEARLY_SIGNIFICANT)
}

/// Inertia and its relative error from whichever parameter is known.
fn scale(ratios: &Ratios, known: &Known) -> Option<(f64, f64)> {
    if let Some(inertia) = known.value(Term::Inertia) {
        return Some((inertia, 0.0));
    }
    if let Some(sine) = known.value(Term::GravitySine) {
        let moment = sine.hypot(known.value(Term::GravityCosine).unwrap_or(0.0));
        let (a, error) = ratios.get(Term::GravitySine)?;
        let b = ratios.get(Term::GravityCosine).map_or(0.0, |(b, _)| b);
        let ratio = a.hypot(b);
        return (ratio > SIGNIFICANT * error).then(|| (moment / ratio, (error / ratio).hypot(INTEGRATION_ERROR)));
    }
    let other = [Term::Viscous, Term::Coulomb].into_iter().find_map(|t| Some((known.value(t)?, ratios.get(t)?)));
    let (value, (ratio, error)) = other?;
    (ratio > SIGNIFICANT * error).then(|| (value / ratio, error / ratio))
}

/// Gravity moment and where hanging is, when the recording rather than the sidecar tells.
fn gravity(result: &mut Fit, ratios: &Ratios, known: &Known, inertia: f64, relative_error: f64, samples: usize) {
    let Some((a, a_error)) = ratios.get(Term::GravitySine) else { return };
    let (b, b_error) = ratios.get(Term::GravityCosine).unwrap_or((0.0, 0.0));
    let ratio = a.hypot(b);
    if known.value(Term::GravitySine).is_none() {
        let error = inertia * a_error.hypot(ratio * relative_error);
        let how = "free motion: ratio to the inertia, which the known parameter gives its size";
        result.parameters.push(Parameter::identified(
            OBJECT,
            "gravity_moment_Nm",
            ratio * inertia,
            error,
            samples,
            how,
        ));
    }
    let phase = (-b).atan2(a);
    let how = "angle at which the mechanism hangs at rest, in the recording's coordinate";
    let parameter = Parameter::identified(OBJECT, PHASE, phase, b_error / ratio.max(f64::MIN_POSITIVE), samples, how);
    result.parameters.push(parameter);
    if phase.abs() > SIGNIFICANT * b_error / ratio && phase.abs() > 0.01 {
        result.warnings.push(format!(
            "the coordinate is not measured from hanging: the mechanism hangs at {phase:.4} rad, which the fit takes into account"
        ));
    }
}

/// Result without a known scale: every parameter is unidentified, only the ratios are reported.
fn unscaled(result: &mut Fit, ratios: &Ratios, coordinate: Coordinate, samples: usize) {
    let why = "a free motion shows only ratios; state one parameter under \"known\" in the sidecar, or record a force";
    for term in [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset] {
        result.parameters.push(Parameter::unidentified(OBJECT, term.name(coordinate), samples, why));
    }
    let mut said = Vec::new();
    for (term, angular, linear) in RATIO_NAMES {
        let name = if coordinate == Coordinate::Angular { angular } else { linear };
        let Some((value, error)) = ratios.get(term) else { continue };
        let how = "free motion: ratio to the inertia";
        result.parameters.push(Parameter::identified(OBJECT, name, value, error, samples, how));
        said.push(format!("{name} {value:.4} ± {error:.2}"));
    }
    result.warnings.push(format!(
        "there is no force column and nothing is known: only ratios to the inertia can be seen ({}); state one parameter under \"known\"",
        said.join(", ")
    ));
}
