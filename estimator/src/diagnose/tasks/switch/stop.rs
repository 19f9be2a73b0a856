//! A finger that presses the knob against its stops: compliance there, and position of the stop relative to the
//! world's.

use super::model::Known;
use super::rows::{Place, Row, Seen, direction};
use crate::diagnose::answer::atlas::{Variable, View};
use crate::diagnose::answer::cause::Found;
use crate::diagnose::free_run::pads::Pads;
use crate::diagnose::hypotheses::candidate::{Candidate, Shape};
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::Compared;
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use crate::estimate::EstimateError;
use crate::segment::SystemState;
use crate::signal::noise::white_noise;
use haptics::law::Kind;

const LEAST_ROWS: usize = 40;
/// Least size of a named cause, in standard errors of the world.
const ERRORS: f64 = 3.0;
/// Least size of an unexplained term, m: a knob rests at a slightly different position each time.
const STRANGE_M: f64 = 6e-5;
/// Largest missing share of the world's pad compliance: ten times as stiff.
const MOST_STIFFER: f64 = 0.9;

/// Compares the causes that move the tip while it presses the knob against a stop. `None` if that was hardly done.
pub fn stop(
    seen: &Seen,
    known: Option<&Known<'_>>,
    rules: Rules,
) -> Result<Option<(Compared, View, Pads)>, EstimateError> {
    let indices: Vec<usize> = (0..seen.rows.len()).filter(|i| matches!(seen.rows[*i].place, Place::Stop(_))).collect();
    if indices.len() < LEAST_ROWS {
        return Ok(None);
    }
    let rows: Vec<Row> = indices.iter().map(|i| seen.rows[*i]).collect();
    let stretch: Vec<usize> = indices.iter().map(|i| seen.stretch[*i]).collect();
    let side = |r: &Row| r.side().unwrap_or(0);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let pressed = |r: &Row| direction(side(r)) * r.above_zero.x;
    let expected = |r: &Row| known.map_or(0.0, |k| k.stopped_m(side(r), pressed(r), r.tip.y));
    let y = of(&|r| direction(side(r)) * r.tip.x - expected(r));
    // Damping of the pads is part of the base model.
    let mut base = vec![of(&|r| direction(side(r)) * r.velocity.x)];
    let usual = rows.iter().map(pressed).fold(0.0, f64::max).max(1e-9);
    let bend = of(&|r| -usual * (pressed(r) / usual).powi(3));
    let force = of(&pressed);
    let on = |wanted: usize| rows.iter().map(|r| f64::from(u8::from(side(r) == wanted))).collect::<Vec<f64>>();
    let mut candidates = Vec::new();
    let plant = |id, name, unit, column| Candidate::one(id, Kind::Plant, name, unit, column);
    if let Some(known) = known {
        // The position of the switch is estimated: it may have been moved.
        base.push(of(&|r| direction(side(r))));
        let least = ERRORS * known.give_error_m_n;
        // However stiff other pads are, their compliance is not negative.
        let shape = Shape::Share {
            least: -MOST_STIFFER / known.pad.spring.k1.max(1e-9),
            whole: f64::NEG_INFINITY,
            most: f64::INFINITY,
        };
        candidates.push(plant("pad-compliance", "give", "m/N", force).at_least(least).shaped(shape));
        for (wanted, name) in [(0, "right stop is nearer by"), (1, "left stop is nearer by")] {
            let nearer = on(wanted).iter().map(|v| -v).collect();
            let wall = plant("added-constraint", name, "m", nearer).positive();
            candidates.push(wall.at_least(ERRORS * known.end_error_m));
            let expression = Some(["the right stop, farther away", "the left stop, farther away"][wanted].to_owned());
            let farther = Candidate { expression, ..plant("other", "way", "m", on(wanted)).positive() };
            candidates.push(farther.at_least(ERRORS * known.end_error_m));
        }
    } else {
        base.extend([0, 1].map(on).into_iter().filter(|c| c.iter().any(|v| *v != 0.0)));
        base.push(force);
        candidates.push(plant("stiffness-hardening", "bend", "m/N", bend).positive());
    }
    let span_s = rows.iter().map(|r| r.time_s).fold(0.0, f64::max).max(1e-9);
    for k in 1..=3 {
        let wave = of(&|r| (std::f64::consts::PI * f64::from(k) * r.time_s / span_s).cos());
        let expression = Some(format!("cos({k} pi t/T)"));
        candidates.push(Candidate { expression, ..plant("other", "amplitude", "m", wave) }.at_least(STRANGE_M));
    }
    let along: Vec<bool> = (0..rows.len()).map(|i| i % 2 == 0).collect();
    let floor = white_noise(&y);
    let layout = Layout::of(stretch.clone(), &along, seen.period_s);
    let study = Channel::new(y, base, candidates, layout, rules).fit()?;
    let over = vec![(Variable::Force, of(&pressed)), (Variable::Time, of(&|r| r.time_s))];
    // The two stops are separate positions.
    let view =
        View { sensor: rows.iter().map(side).collect(), ..View::of(rows.iter().map(|r| r.recording).collect(), over) };
    let (channel, state) = ("place of the tip on the stop", vec![SystemState::Holding; rows.len()]);
    // Pads have damping: the first regressor is the rate.
    let pads = Pads::new(&of(&|r| r.time_s), &stretch, seen.period_s, 0);
    Ok(Some((Compared { study, channel, unit: "m", floor, along, state }, view, pads)))
}

/// Variable that best shows a cause on the stops: the force on the knob.
pub fn best_seen(_: &str) -> Variable {
    Variable::Force
}

/// Sentence on how the residual shows a cause.
pub fn shows(found: &Found<'_>) -> String {
    let value = found.parameters.first().map_or(0.0, |p| p.value);
    match found.candidate.id {
        "pad-compliance" => {
            format!("pressed against a stop, the tip goes {:+.3} mm/N farther than the world's pads give", 1e3 * value)
        }
        "stiffness-hardening" => "pressed harder against a stop, the pads give less and less".to_owned(),
        "added-constraint" => format!("a stop comes {:.2} mm before the world's", 1e3 * value),
        other => format!("{other} shows on the stops"),
    }
}
