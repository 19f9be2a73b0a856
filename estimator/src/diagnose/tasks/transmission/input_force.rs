//! Force at the input of a transmission against its motion and the load.

use super::filtered_columns::Fine;
use super::grid::{Tried, closer};
use super::held_input::Input;
use super::load_confounding::Told;
use super::rows::{Columns, Row, Seen, constants, stretches_of};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{
    coulomb_friction, hysteresis, load_friction, quadratic_drag, return_spring, viscous_friction,
};
use crate::diagnose::tasks::transmission::{Side, fit, generic};
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use haptics::law::Kind;

/// Share of the usual speed below which the direction of friction is uncertain, as it is in rows over a reversal.
const SLOW_SPEED_SHARE: f64 = 0.1;
const SURE_POSTERIOR: f64 = 0.99;

/// Rows with a certain direction of friction.
fn sure(seen: &Seen, usual: f64) -> Vec<usize> {
    let direction: Vec<f64> = seen.fine.iter().flat_map(Fine::direction).collect();
    let is_sure =
        |(row, direction): (&Row, &f64)| direction.abs() > SURE_POSTERIOR && row.rate.abs() > SLOW_SPEED_SHARE * usual;
    seen.kept(&seen.rows.iter().zip(&direction).map(is_sure).collect::<Vec<bool>>())
}

/// The comparison with its free-run model.
pub struct Force {
    pub side: Side,
    /// Separability of friction and load.
    pub told: Option<Told>,
    /// Free-run model of the input.
    pub input: Input,
}

/// The input force against its motion and the load, and the separability of friction from that load.
pub fn force(seen: &Seen, names: &'static Columns) -> Result<Option<Force>, EstimateError> {
    if seen.rows.iter().any(|r| r.force.is_none()) {
        return Ok(None);
    }
    let mut speeds: Vec<f64> = seen.rows.iter().map(|r| r.rate.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    let usual = speeds.get(speeds.len() * 9 / 10).copied().unwrap_or(1.0).max(1e-12);
    let kept = sure(seen, usual);
    let rows = seen.at(&kept);
    let stretch = stretches_of(&rows);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let mut base = constants(&rows);
    let is_loaded = rows.iter().all(|r| r.load.is_some());
    let load = base.len();
    if is_loaded {
        base.push(of(&|r| r.load.unwrap_or(0.0)));
    }
    let inertia = base.len();
    base.push(of(&|r| r.acceleration));
    let direction = seen.column(&kept, &Fine::direction);
    let (low, high) = seen.ends();
    let middle = 0.5 * (low + high);
    let mut plain = vec![
        Candidate::one(coulomb_friction::ID, Kind::Plant, "Fc", names.force_unit, direction.clone()).positive(),
        Candidate::one(viscous_friction::ID, Kind::Plant, "c", "", of(&|r| r.rate)).positive(),
        Candidate::one(return_spring::ID, Kind::Plant, "k", "", of(&|r| r.input - middle)),
        Candidate::one(quadratic_drag::ID, Kind::Plant, "k", "", of(&|r| r.rate * r.rate.abs())).positive(),
    ];
    if is_loaded {
        let column = rows.iter().zip(&direction).map(|(r, d)| r.load.map_or(0.0, f64::abs) * d).collect();
        plain.push(Candidate::one(load_friction::ID, Kind::Plant, "mu", "1", column).positive());
    }
    plain.extend(generic(&rows, low, high));
    let once = |tried: &[Tried]| {
        let bend = |way: &f64| {
            let bent = seen.column(&kept, &|f| f.bent(*way)).iter().zip(&direction).map(|(z, d)| z - d).collect();
            let cause = Candidate::one(hysteresis::ID, Kind::Plant, "Fc", names.force_unit, bent).positive();
            cause.at("way", *way, names.unit)
        };
        let candidates = tried[0].values().iter().map(bend).chain(plain.iter().cloned()).collect();
        fit(of(&|r| r.force.unwrap_or(0.0)), &base, candidates, &rows)
    };
    let study = closer(&mut [Tried::new(hysteresis::ID, high - low)], &once)?;
    let told = if is_loaded { Told::of(&study, load, &direction, &rows) } else { None };
    let floor = white_noise(&seen.rows.iter().map(|r| r.force.unwrap_or(0.0)).collect::<Vec<_>>());
    let input = Input::new((&rows, &stretch), names.force_unit, inertia, seen);
    let side = Side::new(study, rows, ("force at the input", names.force_unit), floor);
    Ok(Some(Force { side, told, input }))
}
