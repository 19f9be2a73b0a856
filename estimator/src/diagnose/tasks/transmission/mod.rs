//! Diagnosis of a transmission: an input that drives an output through gears or a cable. The model is rigid and without
//! friction; lost motion, give under the load and friction of the input are what it may lack.

pub(crate) mod filtered_columns;
pub(crate) mod grid;
pub(crate) mod input_force;
pub(crate) mod lost_motion;
pub(crate) mod rows;

use crate::diagnose::answer::build::{Evidence, answer};
use crate::diagnose::answer::part::Found;
use crate::diagnose::answer::part::Part;
use crate::diagnose::contract::NotExcited;
use crate::diagnose::data::limits::{CERTAIN, PARTS, SHORTEST_S};
use crate::diagnose::data::row_means::mean_and_error;
use crate::diagnose::findings::Findings;
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{
    backlash, coulomb_friction, hysteresis, load_friction, pad_compliance, quadratic_drag, time_delay, viscous_friction,
};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::options;
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use foundation::estimate::EstimateError;
use foundation::tasks::SystemState;
use haptics::recording::Recording;
use rows::{Columns, Row, Seen, columns, stretches_of};

/// Least share of the parts in which work is taken, if it is taken and not given for certain.
/// Choice: no case of the ablation reads it.
const PARTS_OF_ONE_SIGN: f64 = 0.9;

/// True if [`driven`] handles these recordings.
pub fn is_driven(recordings: &[Recording]) -> bool {
    recordings.iter().all(|r| r.time_s.is_some() && columns(r).is_some())
}

/// The comparison of a channel beside structured errors, with the variables of its plots.
fn compared(study: ChannelFit, view: View, (channel, unit): (&'static str, &'static str), floor: f64) -> Compared {
    let rows = study.target.len();
    let (along, state) = (vec![true; rows], vec![SystemState::Turning; rows]);
    Compared { study: settle(study), channel, unit, floor, along, state, view }
}

/// Variables of the plots.
fn view(rows: &[Row], names: &Columns) -> View {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let load = |r: &Row| r.load.or(r.force).unwrap_or(0.0);
    let over = vec![
        (Variable::Place, of(&|r| r.input)),
        (Variable::Velocity, of(&|r| r.rate)),
        (Variable::Load, of(&load)),
        (Variable::Time, of(&|r| r.time_s)),
    ];
    let recording = rows.iter().map(|r| r.recording).collect();
    View { way: of(&|r| r.rate), is_angular: names.unit == "rad", ..View::of(recording, over, best_seen) }
}

/// Diagnoses recordings of one transmission.
pub fn driven(recordings: &[Recording], options: &Options) -> Result<Findings, EstimateError> {
    let Some(names) = recordings.first().and_then(columns) else { return Err(options::nothing()) };
    let mut seen = Seen::of(recordings, names);
    let mut beside = Evidence {
        model: "rigid transmission+input without friction".to_owned(),
        causes: sample_faults::causes(recordings.get(..1).unwrap_or_default()).collect(),
        atlas: options.atlas,
        ..Evidence::default()
    };
    turn(&mut seen.rows, names, &mut beside);
    let way = lost_motion::way(&seen, names)?;
    let force = input_force::force(&seen, names)?;
    if force.is_none() {
        beside.not_excited.push(NotExcited::new(coulomb_friction::ID, "no force at the input was recorded"));
    }
    if seen.rows.iter().all(|r| r.load.is_none()) {
        beside
            .warnings
            .push("no load at the output was recorded: give is told from the force at the input alone".to_owned());
    }
    let told = force.as_ref().and_then(|f| f.told.as_ref());
    if let (Some(force), Some(told)) = (&force, told.filter(|t| t.is_one())) {
        if force.compared.study.has(coulomb_friction::ID) {
            beside.alternatives.extend(told.alternative());
        } else {
            beside.not_excited.push(NotExcited::new(coulomb_friction::ID, input_force::WHY));
        }
    }
    // The force is the quantity that a trainee feels, so its figures represent the whole diagnosis.
    let of_force = force.as_ref().map(|f| Part::of(&f.compared, f).running(FreeRun::Channel(&f.input)));
    let mut parts: Vec<Part<'_>> = of_force.into_iter().collect();
    parts.push(Part::of(&way.compared, &way));
    Ok(answer(&parts, beside))
}

/// Makes the output count in the input's direction, and the force positive if it drives the input. Gears and cables may
/// reverse the direction, which is no fault. The sign of the force follows from its work: friction and compliance
/// cannot return net work.
fn turn(rows: &mut [Row], names: &Columns, beside: &mut Evidence<'_>) {
    let (mut ratio, mut work) = (0.0, Vec::new());
    for own in rows.chunk_by(|a, b| a.recording == b.recording) {
        let mean = |of: &dyn Fn(&Row) -> f64| own.iter().map(of).sum::<f64>() / own.len() as f64;
        // Relative to the means, because sensors have different zeros.
        let (input, output) = (mean(&|r| r.input), mean(&|r| r.output));
        ratio += own.iter().map(|r| (r.input - input) * (r.output - output)).sum::<f64>();
        let force = mean(&|r| r.force.unwrap_or(0.0));
        let parts = own.chunks(own.len().div_ceil(PARTS).max(1));
        work.extend(parts.map(|part| part.iter().map(|r| (r.force.unwrap_or(0.0) - force) * r.rate).sum::<f64>()));
    }
    if ratio < 0.0 {
        for row in rows.iter_mut() {
            row.output = -row.output;
        }
        beside
            .warnings
            .push(format!("{} runs against {}: it is counted the other way round", names.output, names.input));
    }
    if rows.iter().any(|r| r.force.is_none()) {
        return;
    }
    let n = work.len() as f64;
    let (mean, error) = mean_and_error(&work);
    let taken = work.iter().filter(|w| **w < 0.0).count() as f64;
    if work.len() >= PARTS && mean < -CERTAIN * error && taken > PARTS_OF_ONE_SIGN * n {
        for row in rows.iter_mut() {
            row.force = row.force.map(|f| -f);
        }
        beside.causes.push(sample_faults::backwards(names.force));
    }
}

/// Variable that best shows a cause of a transmission.
fn best_seen(id: &str) -> Variable {
    match id {
        coulomb_friction::ID | viscous_friction::ID | quadratic_drag::ID | time_delay::ID => Variable::Velocity,
        pad_compliance::ID | load_friction::ID => Variable::Load,
        _ => Variable::Place,
    }
}

/// A channel of these rows, without candidates.
fn channel(y: Vec<f64>, base: Vec<Vec<f64>>, rows: &[Row], view: &View) -> Channel {
    let layout = Layout::of(stretches_of(rows), &vec![true; rows.len()], SHORTEST_S);
    let laws = [Variable::Velocity, Variable::Load];
    beside_errors(Channel::new(y, base, Vec::new(), layout, Rules::of_channel(SHORTEST_S)), view, &laws)
}

/// Sentence on how the residual shows a cause.
fn shows(found: &Found<'_>) -> String {
    let value = found.value();
    match found.candidate.id {
        backlash::ID => {
            let half = found.candidate.searched.first().map_or(0.0, |s| s.value);
            format!(
                "after each reversal the output waits until the input has gone {:.4} {}",
                2.0 * half,
                found.candidate.searched[0].unit
            )
        }
        hysteresis::ID => "after each reversal the output follows more and more, not at once".to_owned(),
        pad_compliance::ID => "the output gives way under the load".to_owned(),
        coulomb_friction::ID => {
            format!("the force turns round with the direction of motion, whatever the speed ({value:.4})")
        }
        load_friction::ID => "the force turns round with the direction of motion, in proportion to the load".to_owned(),
        other => format!("{other} shows in the transmission"),
    }
}
