//! Diagnosis of a transmission: an input that drives an output through gears or a cable. The model is rigid and without friction; lost
//! motion, give under the load and friction of the input are what it may lack.

use super::answer::{Beside, Found, Part, answer};
use super::atlas::{self, Variable, View};
use super::candidate::Candidate;
use super::compare::{Channel, stretches};
use super::geometry::Study;
use super::report::{CauseParameter, Diagnosis, NotExcited};
use super::{Options, quality, threshold};
use crate::estimate::EstimateError;
use crate::segment::SystemState;
use crate::signal::noise::white_noise;
use crate::signal::task::smooth;
use haptics::law::Kind;
use haptics::recording::Recording;

/// Rows come at about this rate, Hz.
const ROW_HZ: f64 = 50.0;
/// Half gaps that are tried, as shares of the input's range.
const GAPS: [f64; 14] =
    [0.003, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.018, 0.022, 0.027, 0.033, 0.042, 0.055, 0.075, 0.1];
/// The sign of a speed is blurred over this share of the usual one.
const BLUR: f64 = 0.05;
/// The work of the input is looked at in so many equal parts of a recording.
const PARTS: usize = 10;
/// It is taken and not given for certain when its mean is so many standard errors below zero, and so in nearly all of the parts.
const SURELY: f64 = 6.0;
const NEARLY_ALL: f64 = 0.9;

/// One row.
#[derive(Clone, Copy, Debug)]
struct Row {
    recording: usize,
    time_s: f64,
    input: f64,
    output: f64,
    rate: f64,
    acceleration: f64,
    /// Force at the input, and at the output where that was recorded.
    force: Option<f64>,
    load: Option<f64>,
}

/// Names of the columns of one kind of coordinate, and its units.
struct Columns {
    input: &'static str,
    output: &'static str,
    force: &'static str,
    unit: &'static str,
    force_unit: &'static str,
    give: &'static str,
}

static COLUMNS: [Columns; 2] = [
    Columns { input: "q_rad", output: "q_out_rad", force: "tau_Nm", unit: "rad", force_unit: "N m", give: "rad/(N m)" },
    Columns { input: "q_m", output: "q_out_m", force: "f_N", unit: "m", force_unit: "N", give: "m/N" },
];

fn columns(recording: &Recording) -> Option<&'static Columns> {
    COLUMNS.iter().find(|c| recording.channel(c.output).is_some() && recording.channel(c.input).is_some())
}

/// Whether this is what [`driven`] is for.
pub fn is_driven(recordings: &[Recording]) -> bool {
    recordings.iter().all(|r| r.time_s.is_some() && columns(r).is_some())
}

/// Diagnoses recordings of one transmission.
pub fn driven(recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    let Some(names) = recordings.first().and_then(columns) else { return Err(super::nothing()) };
    let mut rows: Vec<Row> = recordings.iter().enumerate().flat_map(|(k, r)| rows(r, k, names)).collect();
    let mut beside = Beside {
        model: "rigid transmission+input without friction".to_owned(),
        causes: recordings.first().map(|r| quality::faults(r).causes).unwrap_or_default(),
        ..Beside::default()
    };
    turn(&mut rows, names, &mut beside);
    let period_s = 1.0 / ROW_HZ;
    let time: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
    let stretch = stretches(&time, period_s, |i| rows[i].recording != rows[i - 1].recording);
    let along = vec![true; rows.len()];
    let state = vec![SystemState::Turning; rows.len()];
    let way = way(&rows, names, &stretch, period_s)?;
    let force = force(&rows, names, &stretch, period_s)?;
    if force.is_none() {
        let why = "no force at the input was recorded".to_owned();
        beside.not_excited.push(NotExcited { id: "coulomb-friction".to_owned(), why });
    }
    if rows.iter().all(|r| r.load.is_none()) {
        beside
            .warnings
            .push("no load at the output was recorded: give is told from the force at the input alone".to_owned());
    }
    let states = |c: &Candidate, mut found: Vec<CauseParameter>| {
        if c.id == "pad-compliance" {
            for p in &mut found {
                p.unit = format!("{}/{}", names.force_unit, names.unit);
            }
        }
        found
    };
    let shown = |f: &Found<'_>| shows(f);
    let part = |study, channel, unit, floor| Part {
        study,
        channel,
        unit,
        floor,
        along: &along,
        stretch: &stretch,
        state: &state,
        shows: &shown,
        states: &states,
        usual: &|_| None,
    };
    let floor = white_noise(&rows.iter().map(|r| r.output).collect::<Vec<_>>());
    let mut named = vec![(&way, "output's place", names.unit, floor)];
    if let Some(force) = &force {
        let floor = white_noise(&rows.iter().map(|r| r.force.unwrap_or(0.0)).collect::<Vec<_>>());
        // The force is what a trainee feels: its figures stand for the whole.
        named.insert(0, (force, "force at the input", names.force_unit, floor));
    }
    let parts: Vec<Part<'_>> = named.iter().map(|(study, name, unit, floor)| part(study, name, unit, *floor)).collect();
    let mut found = answer(&parts, beside, &|_| None);
    if options.atlas {
        let view = view(&rows, names);
        let of = |(study, name, unit, floor): &(&Study, &'static str, &'static str, f64)| {
            atlas::channel(study, (name, unit, *floor), &view, threshold(period_s), best_seen)
        };
        found.atlas.channels = named.iter().map(of).collect();
    }
    Ok(found)
}

/// Counts the output the way the input goes, and the force as what drives the input. Gears and cables may run either way, which is no fault; but
/// nothing that only rubs and gives gives work back for good.
fn turn(rows: &mut [Row], names: &Columns, beside: &mut Beside) {
    let (mut ratio, mut work) = (0.0, Vec::new());
    for own in rows.chunk_by(|a, b| a.recording == b.recording) {
        let mean = |of: &dyn Fn(&Row) -> f64| own.iter().map(of).sum::<f64>() / own.len() as f64;
        // About the means: zeros of sensors differ.
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
    let mean = work.iter().sum::<f64>() / n;
    let error = (work.iter().map(|w| (w - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0) / n).sqrt();
    let taken = work.iter().filter(|w| **w < 0.0).count() as f64;
    if work.len() >= PARTS && mean < -SURELY * error && taken > NEARLY_ALL * n {
        for row in rows.iter_mut() {
            row.force = row.force.map(|f| -f);
        }
        beside.causes.push(quality::backwards(names.force));
    }
}

/// What the rows of both channels are seen against.
fn view(rows: &[Row], names: &Columns) -> View {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let load = |r: &Row| r.load.or(r.force).unwrap_or(0.0);
    let over =
        vec![(Variable::Place, of(&|r| r.input)), (Variable::Velocity, of(&|r| r.rate)), (Variable::Load, of(&load))];
    let recording = rows.iter().map(|r| r.recording).collect();
    View { way: of(&|r| r.rate), is_angular: names.unit == "rad", ..View::of(recording, over) }
}

/// What a cause of a transmission is best seen against.
fn best_seen(id: &str) -> Variable {
    match id {
        "coulomb-friction" | "viscous-friction" | "quadratic-drag" | "time-delay" => Variable::Velocity,
        "pad-compliance" | "load-friction" => Variable::Load,
        _ => Variable::Place,
    }
}

fn rows(recording: &Recording, number: usize, names: &Columns) -> Vec<Row> {
    let (Some(time), Some(input), Some(output)) =
        (recording.time_s.as_ref(), recording.channel(names.input), recording.channel(names.output))
    else {
        return Vec::new();
    };
    let through = |values: &[f64]| smooth(time, values);
    let (input, output) = (through(input), through(output));
    let acceleration = through(&input.slope).slope;
    let force = recording.channel(names.force).map(|f| through(f).value);
    let load = load(recording, names).map(|f| through(f).value);
    let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1).max(1) as f64;
    let every = (1.0 / (ROW_HZ * step_s)).round().max(1.0) as usize;
    (0..time.len())
        .step_by(every)
        .map(|i| Row {
            recording: number,
            time_s: time[i],
            input: input.value[i],
            output: output.value[i],
            rate: input.slope[i],
            acceleration: acceleration[i],
            force: force.as_ref().map(|f| f[i]),
            load: load.as_ref().map(|f| f[i]),
        })
        .collect()
}

/// An extra channel of the force's unit that is not the force at the input: the load at the output.
fn load<'a>(recording: &'a Recording, names: &Columns) -> Option<&'a [f64]> {
    let ending = names.force.rsplit('_').next()?;
    let other =
        recording.channels.iter().find(|c| c.name != names.force && c.name.rsplit('_').next() == Some(ending))?;
    Some(&other.values)
}

/// One constant a recording: zeros of sensors differ.
fn constants(rows: &[Row]) -> Vec<Vec<f64>> {
    let last = rows.iter().map(|r| r.recording).max().unwrap_or(0);
    (0..=last).map(|k| rows.iter().map(|r| f64::from(u8::from(r.recording == k))).collect()).collect()
}

/// The output against the input.
fn way(rows: &[Row], names: &'static Columns, stretch: &[usize], period_s: f64) -> Result<Study, EstimateError> {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let mut base = constants(rows);
    base.push(of(&|r| r.input));
    let (low, high) =
        rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| (a.min(r.input), b.max(r.input)));
    let mut candidates = Vec::new();
    for gap in GAPS.map(|share| share * (high - low)) {
        let lost: Vec<f64> = play(rows, stretch, gap).iter().zip(rows).map(|(p, r)| p - r.input).collect();
        let cause = Candidate::one("backlash", Kind::Plant, "share", "1", lost).positive();
        candidates.push(cause.at("delta", gap, names.unit));
        let bent: Vec<f64> = presliding(rows, stretch, gap).iter().map(|z| -gap * z).collect();
        let cause = Candidate::one("hysteresis", Kind::Plant, "share", "1", bent).positive();
        candidates.push(cause.at("way", gap, names.unit));
    }
    for f in [|r: &Row| r.load, |r: &Row| r.force] {
        if rows.iter().all(|r| f(r).is_some()) {
            // Without its mean over a recording, which the zero of the output has.
            // A load may be counted either way.
            for sign in [1.0, -1.0] {
                let column = of(&|r| sign * f(r).unwrap_or(0.0));
                candidates.push(Candidate::one("pad-compliance", Kind::Plant, "give", names.give, column).positive());
            }
        }
    }
    candidates.push(Candidate::one("time-delay", Kind::Instrument, "tau", "s", of(&|r| -r.rate)));
    candidates.extend(generic(rows, low, high));
    compare(of(&|r| r.output), base, candidates, stretch, period_s)
}

/// The force at the input against its motion and the load.
fn force(
    rows: &[Row],
    names: &'static Columns,
    stretch: &[usize],
    period_s: f64,
) -> Result<Option<Study>, EstimateError> {
    if rows.iter().any(|r| r.force.is_none()) {
        return Ok(None);
    }
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let mut base = constants(rows);
    if rows.iter().all(|r| r.load.is_some()) {
        base.push(of(&|r| r.load.unwrap_or(0.0)));
    }
    base.push(of(&|r| r.acceleration));
    let mut speeds: Vec<f64> = rows.iter().map(|r| r.rate.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    let usual = speeds.get(speeds.len() * 9 / 10).copied().unwrap_or(1.0).max(1e-12);
    let direction = |r: &Row| (r.rate / (BLUR * usual)).tanh();
    let (low, high) =
        rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| (a.min(r.input), b.max(r.input)));
    let middle = 0.5 * (low + high);
    let mut candidates = vec![
        Candidate::one("coulomb-friction", Kind::Plant, "Fc", names.force_unit, of(&direction)).positive(),
        Candidate::one("viscous-friction", Kind::Plant, "c", "", of(&|r| r.rate)).positive(),
        Candidate::one("return-spring", Kind::Plant, "k", "", of(&|r| r.input - middle)),
        Candidate::one("quadratic-drag", Kind::Plant, "k", "", of(&|r| r.rate * r.rate.abs())).positive(),
    ];
    if rows.iter().all(|r| r.load.is_some()) {
        let column = of(&|r| r.load.map_or(0.0, f64::abs) * direction(r));
        candidates.push(Candidate::one("load-friction", Kind::Plant, "mu", "1", column).positive());
    }
    for gap in GAPS.map(|share| share * (high - low)) {
        let bent: Vec<f64> = presliding(rows, stretch, gap).iter().zip(rows).map(|(z, r)| z - direction(r)).collect();
        candidates.push(
            Candidate::one("hysteresis", Kind::Plant, "Fc", names.force_unit, bent)
                .positive()
                .at("way", gap, names.unit),
        );
    }
    candidates.extend(generic(rows, low, high));
    compare(of(&|r| r.force.unwrap_or(0.0)), base, candidates, stretch, period_s).map(Some)
}

fn compare(
    y: Vec<f64>,
    base: Vec<Vec<f64>>,
    candidates: Vec<Candidate>,
    stretch: &[usize],
    period_s: f64,
) -> Result<Study, EstimateError> {
    let n = y.len();
    let channel = Channel {
        y,
        base,
        candidates,
        stretch: stretch.to_vec(),
        testable: vec![true; n],
        weight: vec![1.0; n],
        period_s,
    };
    channel.compare(threshold(period_s))
}

fn generic(rows: &[Row], low: f64, high: f64) -> Vec<Candidate> {
    let range = (high - low).max(1e-12);
    let term = |expression: String, of: &dyn Fn(&Row) -> f64| Candidate {
        expression: Some(expression),
        ..Candidate::one("other", Kind::Plant, "amplitude", "", rows.iter().map(of).collect())
    };
    let mut found: Vec<Candidate> = (2..=5_u32)
        .map(|n| {
            let n = f64::from(n);
            term(format!("cos({n} pi q/Q)"), &move |r| (std::f64::consts::PI * n * (r.input - low) / range).cos())
        })
        .collect();
    found.push(term("v abs(v)".to_owned(), &|r| r.rate * r.rate.abs()));
    found
}

/// The play operator: the middle of a gap that the input pushes along.
fn play(rows: &[Row], stretch: &[usize], half: f64) -> Vec<f64> {
    let mut place = 0.0;
    (0..rows.len())
        .map(|i| {
            if i == 0 || stretch[i] != stretch[i - 1] {
                place = rows[i].input;
            }
            place = f64::clamp(place, rows[i].input - half, rows[i].input + half);
            place
        })
        .collect()
}

/// Dahl's state: −1 … 1, bending over `way` before it slides.
fn presliding(rows: &[Row], stretch: &[usize], way: f64) -> Vec<f64> {
    let mut state = 0.0_f64;
    (0..rows.len())
        .map(|i| {
            if i == 0 || stretch[i] != stretch[i - 1] {
                state = 0.0;
            } else {
                let step = rows[i].input - rows[i - 1].input;
                // Its exact course over a step of one direction.
                let to = step.signum();
                state = to + (state - to) * (-step.abs() / way).exp();
            }
            state
        })
        .collect()
}

/// What in the residual shows a cause.
fn shows(found: &Found<'_>) -> String {
    let value = found.parameters.first().map_or(0.0, |p| p.value);
    match found.candidate.id {
        "backlash" => {
            let half = found.candidate.searched.first().map_or(0.0, |s| s.value);
            format!(
                "after each reversal the output waits until the input has gone {:.4} {}",
                2.0 * half,
                found.candidate.searched[0].unit
            )
        }
        "hysteresis" => "after each reversal the output follows more and more, not at once".to_owned(),
        "pad-compliance" => "the output gives way under the load".to_owned(),
        "coulomb-friction" => {
            format!("the force turns round with the direction of motion, whatever the speed ({value:.4})")
        }
        "load-friction" => "the force turns round with the direction of motion, in proportion to the load".to_owned(),
        other => format!("{other} shows in the transmission"),
    }
}
