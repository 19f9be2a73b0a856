//! A finger that presses the knob against its stops: compliance there, and position of the stop relative to the
//! world's.

use super::model::Known;
use super::rows::{Place, Row, Seen, direction};
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::data::limits::{LEAST_ROWS_OF_A_FIT, SIGNIFICANT};
use crate::diagnose::free_run::channel::Pads;
use crate::diagnose::hypotheses::candidate::{Candidate, Shape};
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{added_constraint, pad_compliance, stiffness_hardening};
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::tasks::SystemState;
use foundation::words::amount;
use haptics::law::Kind;

/// Largest missing share of the world's pad compliance: ten times as stiff.
/// Derived: 1 − 1/10, because the stiffest pads are taken as ten times as stiff.
const MOST_STIFFER: f64 = 0.9;

/// The comparison.
pub struct Pressed {
    pub compared: Compared,
    pub pads: Pads,
}

/// Compares the causes that move the tip while it presses the knob against a stop. `None` if that was hardly done.
pub fn stop(seen: &Seen, known: Option<&Known<'_>>, rules: Rules) -> Result<Option<Pressed>, EstimateError> {
    let indices: Vec<usize> = (0..seen.rows.len()).filter(|i| matches!(seen.rows[*i].place, Place::Stop(_))).collect();
    if indices.len() < LEAST_ROWS_OF_A_FIT {
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
    let usual = rows.iter().map(pressed).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let bend = of(&|r| -usual * (pressed(r) / usual).powi(3));
    let force = of(&pressed);
    let on = |wanted: usize| rows.iter().map(|r| f64::from(u8::from(side(r) == wanted))).collect::<Vec<f64>>();
    let mut candidates = Vec::new();
    if let Some(known) = known {
        // The position of the switch is estimated: it may have been moved.
        base.push(of(&|r| direction(side(r))));
        candidates.extend(beside_a_world(known, force, [0, 1].map(on)));
    } else {
        base.extend([0, 1].map(on).into_iter().filter(|c| c.iter().any(|v| *v != 0.0)));
        base.push(force);
        candidates.push(Candidate::one(stiffness_hardening::ID, Kind::Plant, "bend", "m/N", bend).positive());
    }
    let along: Vec<bool> = (0..rows.len()).map(|i| i % 2 == 0).collect();
    let floor = white_noise(&y);
    let layout = Layout::of(stretch.clone(), &along, seen.period_s);
    let study = Channel::new(y, base, candidates, layout, rules).fit()?;
    let over = vec![(Variable::Force, of(&pressed)), (Variable::Time, of(&|r| r.time_s))];
    // The two stops are separate positions.
    let recording = rows.iter().map(|r| r.recording).collect();
    let by_force = View::of(recording, over, |_| Variable::Force);
    let view = View { sensor: rows.iter().map(side).collect(), ..by_force };
    let (channel, state) = ("place of the tip on the stop", vec![SystemState::Holding; rows.len()]);
    // Pads have damping: the first regressor is the rate.
    let pads = Pads { time_s: of(&|r| r.time_s), stretch, period_s: seen.period_s, rate: 0 };
    Ok(Some(Pressed { compared: Compared { study, channel, unit: "m", floor, along, state, view }, pads }))
}

impl Told for Pressed {
    fn shows(&self, found: &Found<'_>) -> String {
        let value = found.value();
        match found.candidate.id {
            pad_compliance::ID => {
                format!(
                    "pressed against a stop, the tip goes {} farther than the world's pads give",
                    amount(value, "m/N")
                )
            }
            stiffness_hardening::ID => "pressed harder against a stop, the pads give less and less".to_owned(),
            added_constraint::ID => format!("a stop comes {} before the world's", amount(value, "m")),
            other => format!("{other} shows on the stops"),
        }
    }
}

/// Candidates beside a world's switch: pads of another stiffness, and stops at other positions. `on`: rows on the right
/// and on the left stop, as regressors.
fn beside_a_world(known: &Known<'_>, force: Vec<f64>, on: [Vec<f64>; 2]) -> Vec<Candidate> {
    let plant = |id, name, unit, column| Candidate::one(id, Kind::Plant, name, unit, column);
    // However stiff other pads are, their compliance is not negative.
    let shape =
        Shape::Share { least: -MOST_STIFFER / known.pad.spring.k1.max(f64::MIN_POSITIVE), whole: f64::NEG_INFINITY };
    let give = plant(pad_compliance::ID, "give", "m/N", force);
    let mut found = vec![give.at_least(SIGNIFICANT * known.give_error_m_n).shaped(shape)];
    let least_m = SIGNIFICANT * known.end_error_m;
    let names = [
        ("right stop is nearer by", "the right stop, farther away"),
        ("left stop is nearer by", "the left stop, farther away"),
    ];
    for (rows, (nearer, farther)) in on.into_iter().zip(names) {
        let wall = rows.iter().map(|v| -v).collect();
        found.push(plant(added_constraint::ID, nearer, "m", wall).positive().at_least(least_m));
        let expression = Some(farther.to_owned());
        found.push(Candidate { expression, ..plant("other", "way", "m", rows).positive() }.at_least(least_m));
    }
    found
}
