//! Diagnosis of a transmission: an input that drives an output through gears or a cable. The model is rigid and without friction; lost
//! motion, give under the load and friction of the input are what it may lack.

mod beside_load;
mod fine;
mod tried;

use super::answer::{Beside, Compared, Found, answer};
use super::atlas::{Variable, View};
use super::candidate::{Candidate, Shape};
use super::compare::{Channel, stretches};
use super::geometry::Study;
use super::report::{CauseParameter, Diagnosis, NotExcited};
use super::searched::carried_over;
use super::{Options, quality, threshold};
use crate::estimate::EstimateError;
use crate::segment::SystemState;
use crate::signal::noise::{quantum, white_noise};
use crate::signal::task::smooth;
use beside_load::Told;
use fine::Fine;
use haptics::law::Kind;
use haptics::recording::Recording;
use tried::{Tried, closer};

/// Rows come at about this rate, Hz.
const ROW_HZ: f64 = 50.0;
/// A gap that makes up a smaller share of the lost motion, or a larger one, is not what its name says.
const SHARES: [f64; 2] = [0.1, 2.0];
/// What moves the output by less than so many times its noise, or than this share of its sensor's steps, is not told from those steps: an output that
/// waits shows one and the same of them.
const NOISES: f64 = 2.0;
const STEPS_OF_SENSOR: f64 = 0.5;
/// Clocks of two sensors differ by this, and what filters them: an output that is no later is not late, s.
const CLOCKS_DIFFER_S: f64 = 3e-4;
/// Below this share of the usual speed, and where a row looks over a reversal, the direction of friction is a guess.
const SLOW: f64 = 0.1;
const SURE: f64 = 0.99;
/// Fewer rows, as a share, would not stand for a recording.
const FEW: f64 = 0.5;
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

/// Rows of all recordings, and what they were made of.
struct Seen {
    rows: Vec<Row>,
    fine: Vec<Fine>,
    /// Steps of the output's sensor.
    step: f64,
}

impl Seen {
    fn of(recordings: &[Recording], names: &Columns) -> Self {
        let (rows, fine): (Vec<Vec<Row>>, Vec<Fine>) =
            recordings.iter().enumerate().filter_map(|(k, r)| rows(r, k, names)).unzip();
        let step = recordings.iter().filter_map(|r| r.channel(names.output)).map(quantum).fold(0.0, f64::max);
        Self { rows: rows.concat(), fine, step }
    }

    /// One column out of a series of every recording, at some of the rows.
    fn column(&self, kept: &[usize], of: &dyn Fn(&Fine) -> Vec<f64>) -> Vec<f64> {
        let all: Vec<f64> = self.fine.iter().flat_map(of).collect();
        kept.iter().map(|i| all[*i]).collect()
    }

    /// The rows that are wanted; all of a recording of which too few are.
    fn kept(&self, wanted: &[bool]) -> Vec<usize> {
        let mut kept = Vec::new();
        let mut first = 0;
        for own in self.rows.chunk_by(|a, b| a.recording == b.recording) {
            let all = first..first + own.len();
            first = all.end;
            let some: Vec<usize> = all.clone().filter(|i| wanted[*i]).collect();
            kept.extend(if (some.len() as f64) < FEW * own.len() as f64 { all.collect() } else { some });
        }
        kept
    }

    fn at(&self, kept: &[usize]) -> Vec<Row> {
        kept.iter().map(|i| self.rows[*i]).collect()
    }

    /// Lowest and highest place of the input.
    fn ends(&self) -> (f64, f64) {
        self.rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| (a.min(r.input), b.max(r.input)))
    }
}

/// One channel's comparison on the rows that it could be made on.
struct Side {
    compared: Compared,
    rows: Vec<Row>,
}

impl Side {
    fn new(study: Study, rows: Vec<Row>, stretch: Vec<usize>, what: (&'static str, &'static str), floor: f64) -> Self {
        let n = rows.len();
        let (channel, unit) = what;
        let (along, state) = (vec![true; n], vec![SystemState::Turning; n]);
        Self { compared: Compared { study, channel, unit, floor, along, stretch, state }, rows }
    }
}

/// Diagnoses recordings of one transmission.
pub fn driven(recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    let Some(names) = recordings.first().and_then(columns) else { return Err(super::nothing()) };
    let mut seen = Seen::of(recordings, names);
    let mut beside = Beside {
        model: "rigid transmission+input without friction".to_owned(),
        causes: recordings.first().map(|r| quality::faults(r).causes).unwrap_or_default(),
        ..Beside::default()
    };
    turn(&mut seen.rows, names, &mut beside);
    let way = way(&seen, names)?;
    let force = force(&seen, names)?;
    if force.is_none() {
        let why = "no force at the input was recorded".to_owned();
        beside.not_excited.push(NotExcited { id: "coulomb-friction".to_owned(), why });
    }
    if seen.rows.iter().all(|r| r.load.is_none()) {
        beside
            .warnings
            .push("no load at the output was recorded: give is told from the force at the input alone".to_owned());
    }
    let told = force.as_ref().and_then(|(_, told)| told.as_ref());
    if let (Some((force, _)), Some(told)) = (&force, told.filter(|t| t.is_one())) {
        let study = &force.compared.study;
        if study.picks().iter().any(|c| study.candidates[*c].id == "coulomb-friction") {
            beside.alternatives.extend(told.alternative());
        } else {
            let why = beside_load::WHY.to_owned();
            beside.not_excited.push(NotExcited { id: "coulomb-friction".to_owned(), why });
        }
    }
    let way_states =
        |c: &Candidate, found: Vec<CauseParameter>| as_of_input(&way.compared.study, c, found, (names, seen.step));
    let force_states = |c: &Candidate, mut found: Vec<CauseParameter>| {
        if let (Some(told), true) = (told, c.id == "coulomb-friction") {
            for p in &mut found {
                p.std_error = p.std_error.hypot(told.error(p.value));
            }
        }
        found
    };
    let shown = |f: &Found<'_>| shows(f);
    let mut parts = Vec::new();
    // The force is what a trainee feels: its figures stand for the whole.
    parts.extend(force.as_ref().map(|(force, _)| force.compared.part(&shown, &force_states, &|_| None)));
    parts.push(way.compared.part(&shown, &way_states, &|_| None));
    let mut found = answer(&parts, beside, &|_| None);
    if options.atlas {
        let sides = force.iter().map(|(force, _)| force).chain([&way]);
        let period_s = 1.0 / ROW_HZ;
        found.atlas.channels =
            sides.map(|side| side.compared.atlas(&view(&side.rows, names), threshold(period_s), best_seen)).collect();
    }
    Ok(found)
}

/// Parameters of what the output shows, for the input: the output moves by the ratio. Of a gap's share it is not known better than the gap is.
fn as_of_input(
    study: &Study,
    own: &Candidate,
    mut found: Vec<CauseParameter>,
    (names, step): (&Columns, f64),
) -> Vec<CauseParameter> {
    let place = study.chosen.iter().position(|c| std::ptr::eq(&raw const study.candidates[c.candidate], own));
    let ratio = study.solved.as_ref().map_or(1.0, |s| s.values[study.system.base - 1]);
    // An output that waits behind a gap shows one step of its sensor, wherever within that it is.
    let unseen = step / 12.0_f64.sqrt() / ratio.abs();
    let searched = own.searched.first().map_or(f64::INFINITY, |s| s.value);
    for p in &mut found {
        match p.name.as_str() {
            "share" => {
                let carried = place.map_or(0.0, |k| carried_over(study, k));
                let error = (p.std_error.hypot(carried) / ratio).abs();
                (p.value, p.std_error) = (p.value / ratio, error.hypot(unseen / searched));
            }
            "delta" | "way" => p.std_error = p.std_error.hypot(unseen),
            "tau" => {
                // Noise of a regressor makes its weight small.
                let small = place.map_or(0.0, |k| p.value * noise_of_own(study, study.chosen[k].candidate));
                (p.value, p.std_error) = (p.value / ratio, (p.std_error.hypot(small) / ratio).abs());
            }
            "k" if own.id == "pad-compliance" => p.unit = format!("{}/{}", names.force_unit, names.unit),
            _ => {}
        }
    }
    found
}

/// Share of a candidate's first column, as the comparison sees it, that is noise.
fn noise_of_own(study: &Study, candidate: usize) -> f64 {
    let system = &study.system;
    let first = system.places[candidate].start;
    let whitened = 1.0 + system.coefficients.iter().map(|a| a * a).sum::<f64>();
    let power = (system.train[(first, first)] / system.rows.max(1.0)).max(f64::MIN_POSITIVE);
    (study.candidates[candidate].noise.powi(2) * whitened / power).min(1.0)
}

/// Standard deviation.
fn spread(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
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

/// Rows of one recording, and its input at its own rate.
fn rows(recording: &Recording, number: usize, names: &Columns) -> Option<(Vec<Row>, Fine)> {
    let time = recording.time_s.as_ref().filter(|t| !t.is_empty())?;
    let (raw, output) = (recording.channel(names.input)?, recording.channel(names.output)?);
    let through = |values: &[f64]| smooth(time, values);
    let (input, output) = (through(raw), through(output));
    let acceleration = through(&input.slope).slope;
    let force = recording.channel(names.force).map(|f| through(f).value);
    let load = load(recording, names).map(|f| through(f).value);
    let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1).max(1) as f64;
    let every = (1.0 / (ROW_HZ * step_s)).round().max(1.0) as usize;
    let row = |i: usize| Row {
        recording: number,
        time_s: time[i],
        input: input.value[i],
        output: output.value[i],
        rate: input.slope[i],
        acceleration: acceleration[i],
        force: force.as_ref().map(|f| f[i]),
        load: load.as_ref().map(|f| f[i]),
    };
    Some(((0..time.len()).step_by(every).map(row).collect(), Fine::new(time, raw, every)))
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
    let mut numbers: Vec<usize> = rows.iter().map(|r| r.recording).collect();
    numbers.dedup();
    numbers.iter().map(|k| rows.iter().map(|r| f64::from(u8::from(r.recording == *k))).collect()).collect()
}

/// Rows that follow each other.
fn stretches_of(rows: &[Row]) -> Vec<usize> {
    let time: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
    stretches(&time, 1.0 / ROW_HZ, |i| rows[i].recording != rows[i - 1].recording)
}

/// Slope of the output over the input, about the means of each recording.
fn ratio(rows: &[Row]) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for own in rows.chunk_by(|a, b| a.recording == b.recording) {
        let mean = |of: fn(&Row) -> f64| own.iter().map(of).sum::<f64>() / own.len() as f64;
        let (input, output) = (mean(|r| r.input), mean(|r| r.output));
        product += own.iter().map(|r| (r.input - input) * (r.output - output)).sum::<f64>();
        square += own.iter().map(|r| (r.input - input).powi(2)).sum::<f64>();
    }
    product / square.max(f64::MIN_POSITIVE)
}

/// The output against the input.
fn way(seen: &Seen, names: &'static Columns) -> Result<Side, EstimateError> {
    let (low, high) = seen.ends();
    let kept: Vec<usize> = (0..seen.rows.len()).collect();
    let rows = &seen.rows;
    let stretch = stretches_of(rows);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let mut base = constants(rows);
    base.push(of(&|r| r.input));
    let lever = ratio(rows);
    let share = Shape::Share { least: SHARES[0] * lever, whole: f64::NEG_INFINITY, most: SHARES[1] * lever };
    // What moves the output by so little may be the steps of its sensor.
    let noise = white_noise(&rows.iter().map(|r| r.output).collect::<Vec<_>>());
    let least =
        |column: &[f64]| (NOISES * noise).max(STEPS_OF_SENSOR * seen.step) / spread(column).max(f64::MIN_POSITIVE);
    let mut plain = Vec::new();
    for f in [|r: &Row| r.load, |r: &Row| r.force] {
        if rows.iter().all(|r| f(r).is_some()) {
            // Without its mean over a recording, which the zero of the output has.
            // A load may be counted either way.
            for sign in [1.0, -1.0] {
                let column = of(&|r| sign * f(r).unwrap_or(0.0));
                let least = least(&column);
                let gives = Candidate::one("pad-compliance", Kind::Plant, "give", names.give, column);
                plain.push(gives.positive().at_least(least));
            }
        }
    }
    let late = of(&|r| -r.rate);
    let least_late = least(&late).max(CLOCKS_DIFFER_S * lever.abs());
    let rate_noise = seen.fine.iter().map(Fine::rate_noise).fold(0.0, f64::max);
    plain.push(Candidate::one("time-delay", Kind::Instrument, "tau", "s", late).at_least(least_late).noisy(rate_noise));
    plain.extend(generic(rows, low, high).into_iter().map(|term| {
        let least = least(&term.columns[0]);
        term.at_least(least)
    }));
    let once = |tried: &[Tried]| {
        let gap = |half: &f64| {
            let lost = seen.column(&kept, &|f| f.lost(*half));
            let cause = Candidate::one("backlash", Kind::Plant, "share", "1", lost).positive().shaped(share);
            cause.at("delta", *half, names.unit)
        };
        let bend = |way: &f64| {
            let bent = seen.column(&kept, &|f| f.bent(*way)).iter().map(|z| -way * z).collect();
            let cause = Candidate::one("hysteresis", Kind::Plant, "share", "1", bent).positive().shaped(share);
            cause.at("way", *way, names.unit)
        };
        let searched = tried[0].values().iter().map(gap).chain(tried[1].values().iter().map(bend));
        let candidates = searched.chain(plain.iter().cloned()).collect();
        channel(of(&|r| r.output), base.clone(), candidates, &stretch).compare(threshold(1.0 / ROW_HZ))
    };
    let mut tried = ["backlash", "hysteresis"].map(|id| Tried::new(id, high - low));
    let study = closer(&mut tried, &once)?;
    Ok(Side::new(study, rows.clone(), stretch, ("output's place", names.unit), noise))
}

/// Rows at which the direction of friction is no guess.
fn sure(seen: &Seen, usual: f64) -> Vec<usize> {
    let direction: Vec<f64> = seen.fine.iter().flat_map(Fine::direction).collect();
    let is_sure = |(row, direction): (&Row, &f64)| direction.abs() > SURE && row.rate.abs() > SLOW * usual;
    seen.kept(&seen.rows.iter().zip(&direction).map(is_sure).collect::<Vec<bool>>())
}

/// The force at the input against its motion and the load, and how well friction is told from that load.
fn force(seen: &Seen, names: &'static Columns) -> Result<Option<(Side, Option<Told>)>, EstimateError> {
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
    base.push(of(&|r| r.acceleration));
    let direction = seen.column(&kept, &Fine::direction);
    let (low, high) = seen.ends();
    let middle = 0.5 * (low + high);
    let mut plain = vec![
        Candidate::one("coulomb-friction", Kind::Plant, "Fc", names.force_unit, direction.clone()).positive(),
        Candidate::one("viscous-friction", Kind::Plant, "c", "", of(&|r| r.rate)).positive(),
        Candidate::one("return-spring", Kind::Plant, "k", "", of(&|r| r.input - middle)),
        Candidate::one("quadratic-drag", Kind::Plant, "k", "", of(&|r| r.rate * r.rate.abs())).positive(),
    ];
    if is_loaded {
        let column = rows.iter().zip(&direction).map(|(r, d)| r.load.map_or(0.0, f64::abs) * d).collect();
        plain.push(Candidate::one("load-friction", Kind::Plant, "mu", "1", column).positive());
    }
    plain.extend(generic(&rows, low, high));
    let once = |tried: &[Tried]| {
        let bend = |way: &f64| {
            let bent = seen.column(&kept, &|f| f.bent(*way)).iter().zip(&direction).map(|(z, d)| z - d).collect();
            let cause = Candidate::one("hysteresis", Kind::Plant, "Fc", names.force_unit, bent).positive();
            cause.at("way", *way, names.unit)
        };
        let candidates = tried[0].values().iter().map(bend).chain(plain.iter().cloned()).collect();
        let channel = channel(of(&|r| r.force.unwrap_or(0.0)), base.clone(), candidates, &stretch);
        channel.compare(threshold(1.0 / ROW_HZ))
    };
    let study = closer(&mut [Tried::new("hysteresis", high - low)], &once)?;
    let told = if is_loaded { Told::of(&study, load, &direction, &rows) } else { None };
    let floor = white_noise(&seen.rows.iter().map(|r| r.force.unwrap_or(0.0)).collect::<Vec<_>>());
    Ok(Some((Side::new(study, rows, stretch, ("force at the input", names.force_unit), floor), told)))
}

fn channel(y: Vec<f64>, base: Vec<Vec<f64>>, candidates: Vec<Candidate>, stretch: &[usize]) -> Channel {
    let n = y.len();
    Channel {
        y,
        base,
        candidates,
        stretch: stretch.to_vec(),
        testable: vec![true; n],
        weight: vec![1.0; n],
        period_s: 1.0 / ROW_HZ,
    }
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
