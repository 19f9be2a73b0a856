//! Measured curve against that of a world: friction, springs and local resistance that the world lacks, and scales of
//! sensors.
//!
//! A world is known only so well: what is smaller than its own stated errors is no cause.

use super::held_knob::{Knob, Point, bind_n};
use super::model::Known;
use super::rows::direction;
use super::throw::Push;
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::data::limits::{LEAST_PHASE_SAMPLES, LEAST_ROWS_OF_A_FIT, SIGNIFICANT};
use crate::diagnose::experiment::separation::Imagined;
use crate::diagnose::experiment::strokes::PEAK;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::{Candidate, Shape};
use crate::diagnose::hypotheses::local_resistance::PLACES;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{
    coulomb_friction, force_gain, friction_asymmetry, length_scale, local_resistance, return_spring, viscous_friction,
};
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{Compared, View};
use crate::diagnose::selection::layout::{Layout, segments};
use crate::diagnose::selection::rules::Rules;
use foundation::estimate::EstimateError;
use foundation::tasks::SystemState;
use foundation::words::amount;
use haptics::law::Kind;

/// Tried widths of a local resistance, as shares of the travel.
/// Choice: halved, 1 of 12 answers change (1 to wrong); doubled, 2 of 12 answers change.
const CURVE_WIDTHS: Axis = Axis::geometric(0.08, 0.3, 4);

/// The comparison.
pub struct Beside {
    pub compared: Compared,
    pub knob: Knob,
}

/// Compares the measured curve with the world's. `None` if too little of it was seen.
pub fn curve(push: &Push, known: &Known<'_>, period_s: f64, rules: Rules) -> Result<Option<Beside>, EstimateError> {
    let viscous = push.compared.study.has(viscous_friction::ID);
    let mut times = Vec::new();
    let mut points = Vec::new();
    for (row, found_n) in &push.rows {
        let Some(side) = row.side() else { continue };
        let at_m = known.at_m(row, side);
        if known.bends_near(at_m) || known.switch.curve.is_stopped(at_m) {
            continue;
        }
        let (asked_n, slope_n_m) = known.asked_n(at_m, side);
        let damped_n = if viscous { 0.0 } else { known.damping_n_s_m * row.speed_m_s() };
        let residual_n = known.driving_n(row.force, at_m, side) - found_n - asked_n - damped_n;
        times.push((row.recording, row.time_s));
        points.push(Point { side, at_m, speed_m_s: row.speed_m_s(), residual_n, asked_n, slope_n_m });
    }
    if points.len() < LEAST_ROWS_OF_A_FIT {
        return Ok(None);
    }
    let time: Vec<f64> = times.iter().map(|t| t.1).collect();
    let stretch = segments(&time, period_s, |i| times[i].0 != times[i - 1].0 || points[i].side != points[i - 1].side);
    let of = |f: &dyn Fn(&Point) -> f64| points.iter().map(f).collect::<Vec<f64>>();
    let (base, y) = (base(&points), of(&|p| p.residual_n));
    let candidates = candidates(&points, known, viscous);
    let along: Vec<bool> = (0..points.len()).map(|i| i % 2 == 0).collect();
    let layout = Layout::of(stretch.clone(), &along, period_s);
    let (channel, unit) = ("force over the knob's way beside the world's curve", "N");
    // A world's curve is known only so well.
    let floor = push.compared.floor.hypot(SIGNIFICANT * known.error_n);
    let over = vec![
        (Variable::Time, time.clone()),
        (Variable::Place, of(&|p| p.at_m)),
        (Variable::Velocity, of(&|p| p.speed_m_s)),
        (Variable::Force, of(&|p| p.asked_n)),
    ];
    let state = vec![SystemState::Turning; points.len()];
    let recording = times.iter().map(|t| t.0).collect();
    let view = View { way: of(&|p| direction(p.side)), ..View::of(recording, over, best_seen) };
    let beside = beside_errors(Channel::new(y, base, candidates, layout, rules), &view, &[]);
    // The laws are functions of the place, as a structured error is: they do not compete, but the noise is learnt beside it.
    let study = beside.fit()?;
    let time = times.iter().map(|t| t.1).collect();
    let knob = Knob::captured(&known.switch.curve, points, time, &stretch, period_s);
    Ok(Some(Beside { compared: Compared { study, channel, unit, floor, along, state, view }, knob }))
}

/// Variable that best shows a cause.
fn best_seen(id: &str) -> Variable {
    match id {
        viscous_friction::ID => Variable::Velocity,
        force_gain::ID => Variable::Force,
        _ => Variable::Place,
    }
}

impl Told for Beside {
    fn shows(&self, found: &Found<'_>) -> String {
        let value = found.value();
        match found.candidate.id {
            coulomb_friction::ID => {
                format!("the knob asks for {} more than the world's in both directions", amount(value, "N"))
            }
            friction_asymmetry::ID => {
                format!("the knob asks for {} more than the world's in one direction alone", amount(value, "N"))
            }
            viscous_friction::ID => "what the knob asks for beyond the world's goes with its speed".to_owned(),
            return_spring::ID => "the knob is drawn to one place, the same in both directions".to_owned(),
            local_resistance::ID => {
                format!(
                    "the knob binds at {} of its way: it asks for {} more there in both directions",
                    amount(found.value_of("place"), "m"),
                    amount(value, "N")
                )
            }
            force_gain::ID => format!(
                "all forces are {:+.1} % of the world's too large; a switch that is harder by as much would look the same",
                100.0 * value
            ),
            length_scale::ID => format!("the curve is {:+.1} % longer than the world's", 100.0 * value),
            other => format!("{other} shows beside the world's curve"),
        }
    }
}

/// Position of the switch, which may have been moved, as a regressor.
fn base(points: &[Point]) -> Vec<Vec<f64>> {
    vec![points.iter().map(|p| direction(p.side) * p.slope_n_m).collect()]
}

/// Predicted regressors on throws that have not been made yet: of each its side, its highest speed, m/s, and its
/// travel, m.
pub fn imagined(throws: &[(usize, f64, f64)], known: &Known<'_>, period_s: f64) -> Imagined {
    let half = known.half_way_m();
    let (mut points, mut stretch) = (Vec::new(), Vec::new());
    for (number, (side, fast_m_s, way_m)) in throws.iter().enumerate() {
        for (travel_m, speed_m_s) in pushed(*fast_m_s, *way_m, period_s) {
            // A finger that begins before the knob is on the other side of the middle.
            let at_m = direction(*side) * (travel_m - 0.5 * way_m);
            // The knob leaves the finger half way.
            if at_m.abs() > half || direction(*side) * at_m > 0.0 || known.bends_near(at_m) {
                continue;
            }
            let (asked_n, slope_n_m) = known.asked_n(at_m, *side);
            points.push(Point { side: *side, at_m, speed_m_s, residual_n: 0.0, asked_n, slope_n_m });
            stretch.push(number);
        }
    }
    Imagined::of(base(&points), candidates(&points, known, false), stretch)
}

/// Travel and speed of a smooth movement, every `period_s`.
pub fn pushed(fast_m_s: f64, way_m: f64, period_s: f64) -> impl Iterator<Item = (f64, f64)> {
    let takes_s = PEAK * way_m / fast_m_s.max(f64::MIN_POSITIVE);
    (0..(takes_s / period_s) as usize).map(move |k| {
        let u = k as f64 * period_s / takes_s;
        let gone = way_m * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        (gone, fast_m_s * 16.0 * (u * (1.0 - u)).powi(2))
    })
}

fn candidates(points: &[Point], known: &Known<'_>, viscous: bool) -> Vec<Candidate> {
    let of = |f: &dyn Fn(&Point) -> f64| points.iter().map(f).collect::<Vec<f64>>();
    let one = |id, name, unit, column| Candidate::one(id, Kind::Plant, name, unit, column);
    let half = known.half_way_m();
    let on = |side: usize| move |p: &Point| f64::from(u8::from(p.side == side));
    let mut found = vec![
        one(coulomb_friction::ID, "Fc", "N", vec![1.0; points.len()]).positive(),
        one(friction_asymmetry::ID, "dFc to the right", "N", of(&on(0))),
        one(friction_asymmetry::ID, "dFc to the left", "N", of(&on(1))),
    ];
    if !viscous {
        found.push(one(viscous_friction::ID, "c", "N s/m", of(&|p| p.speed_m_s)).positive());
    }
    let spring = vec![of(&|p| direction(p.side) * p.at_m), of(&|p| direction(p.side))];
    let names = vec![("k", "N/m"), ("f0", "N")];
    found.push(Candidate::several(return_spring::ID, Kind::Plant, spring, names).shaped(Shape::Spring { half }));
    for place in PLACES.values().map(|share| half * (2.0 * share - 1.0)) {
        for width in CURVE_WIDTHS.values().map(|share| 2.0 * half * share) {
            let bind = one(local_resistance::ID, "F", "N", of(&|p| bind_n(p.at_m, place, width))).positive();
            if bind.regressors[0].iter().filter(|v| **v > 0.3).count() >= LEAST_PHASE_SAMPLES {
                found.push(bind.at("place", place, "m").at("width", width, "m"));
            }
        }
    }
    found.push(Candidate::one(force_gain::ID, Kind::Instrument, "g - 1", "1", of(&|p| p.asked_n)));
    let scaled = of(&|p| -direction(p.side) * p.slope_n_m * p.at_m);
    found.push(Candidate::one(length_scale::ID, Kind::Instrument, "epsilon", "1", scaled));
    found.into_iter().map(|c| seen(c, SIGNIFICANT * known.error_n)).collect()
}

/// A cause that must reach some force, N, where it acts.
fn seen(candidate: Candidate, least_n: f64) -> Candidate {
    let column = &candidate.regressors[0];
    let most = column.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let acts: Vec<f64> = column.iter().filter(|v| v.abs() > 0.1 * most).map(|v| v * v).collect();
    let size = (acts.iter().sum::<f64>() / acts.len().max(1) as f64).sqrt();
    candidate.at_least(least_n / size.max(f64::MIN_POSITIVE))
}
