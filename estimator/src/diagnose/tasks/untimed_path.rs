//! Diagnosis of a tool path without a clock: a door or drawer that was pulled. Nothing that needs a rate can be told;
//! what depends on the place can, and so can two estimates of one force that do not agree.

use crate::diagnose::answer::build::{Evidence, answer};
use crate::diagnose::answer::part::{Found, Part, Told};
use crate::diagnose::contract::NotExcited;
use crate::diagnose::data::limits::FEWEST;
use crate::diagnose::findings::Findings;
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::free_run::windows::NO_CLOCK;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::local_resistance::PLACES;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{
    coulomb_friction, force_bias, force_cross_axis, force_gain, inertia, local_resistance, return_spring, time_delay,
    viscous_friction,
};
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use estimation::constraint::detect_in;
use estimation::identify::mechanism::path;
use estimation::identify::mechanism::path::{from_constraint, project};
use foundation::estimate::{ConstraintKind, EstimateError};
use foundation::signal::noise::white_noise;
use foundation::tasks::SystemState;
use haptics::law::{Effect, Kind, Law, LocalResistance, Motion, ReturnSpring};
use haptics::recording::Recording;

/// Number of equal parts of the path, with the mean force of each.
/// Choice: no case of the ablation reads it.
const PATH_PARTS: usize = 160;
/// Tried widths of a local resistance, as shares of the range.
/// Choice: no case of the ablation reads it.
const PATH_WIDTHS: Axis = Axis::geometric(0.08, 0.9, 6);

/// Units of force and place.
struct Units {
    force: &'static str,
    place: &'static str,
    per_place: &'static str,
    per_cube: &'static str,
    is_angular: bool,
}

static ROUND: Units =
    Units { force: "N m", place: "rad", per_place: "N m/rad", per_cube: "N m/rad³", is_angular: true };
static STRAIGHT: Units = Units { force: "N", place: "m", per_place: "N/m", per_cube: "N/m³", is_angular: false };

/// The force along the path.
struct AlongPath {
    compared: Compared,
    /// Course of the force, in words.
    falls: String,
}

/// Two estimates of one force.
struct Second {
    compared: Compared,
    /// Name of the second one.
    which: String,
}

/// One part of the path of a recording.
#[derive(Clone, Debug)]
struct Row {
    recording: usize,
    /// Position from the start, m or rad.
    place: f64,
    direction: f64,
    /// Force along the coordinate, N or N m.
    force: f64,
    /// Measured force, and the second estimate of it, N.
    measured_n: [f64; 3],
    second_n: Option<[f64; 3]>,
}

/// True if [`pulled`] handles these recordings.
pub fn is_pulled(recordings: &[Recording]) -> bool {
    recordings.iter().all(|r| r.time_s.is_none() && path::points(r).is_some())
}

/// Diagnoses paths of one mechanism.
pub fn pulled(recordings: &[Recording], options: &Options) -> Result<Findings, EstimateError> {
    let (mut rows, mut kinds) = (Vec::new(), Vec::new());
    let mut beside = Evidence::default();
    for (k, recording) in recordings.iter().enumerate() {
        let Some(found) = detect_in(recording) else { continue };
        kinds.push(found.kind);
        match from_constraint(&found, recording) {
            Some(path) => rows.extend(parts(recording, k, &project(recording, &path)?)),
            None => beside.warnings.push(format!(
                "the path of {} is neither a line nor a circle for certain ({})",
                recording.name, found.evidence
            )),
        }
    }
    beside.causes = sample_faults::causes(recordings.get(..1).unwrap_or_default()).collect();
    let count = |kind: ConstraintKind| kinds.iter().filter(|k| **k == kind).count();
    let (turns, slides) = (count(ConstraintKind::Revolute), count(ConstraintKind::Prismatic));
    if turns + slides == 0 {
        return Err(EstimateError::Other(format!(
            "nothing can be compared: {}; without a clock only a line or a circle, and the force along it, can be diagnosed; record a longer path, or add the times (t_s, or rate_hz in the sidecar)",
            beside.warnings.first().map_or("no path was recorded", String::as_str)
        )));
    }
    let (kind, units) = if turns >= slides && turns > 0 { ("a circle", &ROUND) } else { ("a line", &STRAIGHT) };
    beside.warnings.push(format!(
        "the paths follow {kind} ({turns} revolute, {slides} prismatic of {}); without a clock nothing that depends on speed can be told",
        kinds.len()
    ));
    // Causes that depend on speed or time.
    let timed = [inertia::ID, viscous_friction::ID, time_delay::ID];
    let why = "there is no clock; give a t_s column or rate_hz";
    beside.not_excited.extend(timed.map(|id| NotExcited::new(id, why)));
    // A quarter of the parts of one path.
    let least = PATH_PARTS / 4;
    let has_forces = recordings.iter().all(|r| path::forces(r).is_some());
    let forced = has_forces && rows.len() >= least;
    beside.model = if forced { format!("{kind}+coulomb-friction") } else { kind.to_owned() };
    if !forced {
        let few = format!("the path has {} places with a force, and {least} are needed", rows.len());
        let why = if has_forces { few.as_str() } else { "no force was recorded: a path alone shows its shape" };
        beside.not_excited.push(NotExcited::new(coulomb_friction::ID, why));
        return Ok(answer(&[], beside));
    }
    if drives_backwards(&rows) {
        for row in &mut rows {
            row.force = -row.force;
            row.measured_n = row.measured_n.map(|f| -f);
            row.second_n = row.second_n.map(|s| s.map(|f| -f));
        }
        beside.causes.push(sample_faults::backwards("fx, fy and fz"));
    }
    let along = along(&rows, units)?;
    let names = recordings.first().and_then(second_names);
    let second = second(&rows, units, names)?;
    let mut parts = vec![Part::of(&along.compared, &along).running(FreeRun::None(NO_CLOCK))];
    parts.extend(second.as_ref().map(|second| Part::of(&second.compared, second).running(FreeRun::None(NO_CLOCK))));
    Ok(answer(&parts, Evidence { atlas: options.atlas, ..beside }))
}

/// Variables of the plots of the force along the path.
fn view(rows: &[Row]) -> View {
    let over = vec![(Variable::Place, rows.iter().map(|r| r.place).collect())];
    let way = rows.iter().map(|r| r.direction).collect();
    View { way, ..View::of(rows.iter().map(|r| r.recording).collect(), over, |_| Variable::Place) }
}

/// Variables of the plots of two forces: the rows of all three axes follow each other.
fn view_of_both(rows: &[Row]) -> View {
    let each =
        |f: &dyn Fn(&Row, usize) -> f64| (0..3).flat_map(|a| rows.iter().map(move |r| f(r, a))).collect::<Vec<f64>>();
    let across = |r: &Row, axis: usize| if axis < 2 { r.measured_n[1 - axis] } else { 0.0 };
    let over = vec![
        (Variable::Place, each(&|r, _| r.place)),
        (Variable::Force, each(&|r, axis| r.measured_n[axis])),
        (Variable::Across, each(&across)),
    ];
    let sensor = (0..3).flat_map(|axis| rows.iter().map(move |_| axis)).collect();
    View { sensor, ..View::of((0..3).flat_map(|_| rows.iter().map(|r| r.recording)).collect(), over, best_seen) }
}

/// A door does not drive the person who opens it: a force that takes work all the way is the reaction on the hand.
fn drives_backwards(rows: &[Row]) -> bool {
    let work: f64 = rows.iter().map(|r| r.force * r.direction).sum();
    let size: f64 = rows.iter().map(|r| r.force.abs()).sum();
    work < -0.5 * size
}

/// Equal parts of the travelled path.
fn parts(recording: &Recording, number: usize, seen: &path::Projected) -> Vec<Row> {
    let n = seen.position.len();
    let travelled: Vec<f64> = seen
        .position
        .windows(2)
        .scan(0.0, |sum, pair| {
            *sum += (pair[1] - pair[0]).abs();
            Some(*sum)
        })
        .collect();
    let Some(whole) = travelled.last().copied().filter(|w| *w > 0.0) else { return Vec::new() };
    let count = (n / FEWEST).clamp(1, PATH_PARTS);
    let axes = |names: [&str; 3]| names.map(|name| recording.channel(name).map(<[f64]>::to_vec));
    let measured = axes(["fx_N", "fy_N", "fz_N"]);
    let second = second_names(recording).map(|names| names.map(|n| recording.channel(&n).map(<[f64]>::to_vec)));
    let mut rows = Vec::new();
    let mut start = 0;
    for k in 1..=count {
        let end = 1 + travelled.partition_point(|t| *t < whole * k as f64 / count as f64);
        let end = end.min(n);
        if end <= start {
            continue;
        }
        let mean = |values: &[f64]| values[start..end].iter().sum::<f64>() / (end - start) as f64;
        let three = |of: &[Option<Vec<f64>>; 3]| [0, 1, 2].map(|a: usize| of[a].as_deref().map_or(0.0, mean));
        let last = end.min(n - 1);
        rows.push(Row {
            recording: number,
            place: mean(&seen.position),
            direction: (seen.position[last] - seen.position[start]).signum(),
            force: seen.force.as_deref().map_or(0.0, mean),
            measured_n: three(&measured),
            second_n: second.as_ref().map(three),
        });
        start = end;
    }
    rows
}

/// Channels of another estimate of the same force: `fx_<words>_N`, `fy_<words>_N` (and z).
fn second_names(recording: &Recording) -> Option<[String; 3]> {
    let own = |name: &&str| name.starts_with("fx_") && name.ends_with("_N") && *name != "fx_N";
    let first = recording.channels.iter().map(|c| c.name.as_str()).find(own)?;
    let names = ["fx_", "fy_", "fz_"].map(|start| format!("{start}{}", &first[3..]));
    recording.channel(&names[1]).map(|_| names)
}

/// Comparison of the force along the path over position. The base model is the dry friction of one direction.
fn along(rows: &[Row], units: &Units) -> Result<AlongPath, EstimateError> {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let (low, high) =
        rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| (a.min(r.place), b.max(r.place)));
    let range = (high - low).max(f64::MIN_POSITIVE);
    let mut base = vec![of(&|r| r.direction)];
    if rows.iter().any(|r| r.direction != rows[0].direction) {
        base.push(vec![1.0; rows.len()]);
    }
    let motion = |r: &Row| Motion { position: r.place, direction: r.direction, ..Motion::default() };
    let law = |law: &'static dyn Law, values: &[f64]| {
        let effect = Effect::new(law, values);
        of(&|r| effect.force(&motion(r)))
    };
    let middle = 0.5 * (low + high);
    let (spring, harder) = (law(&ReturnSpring, &[1.0, 0.0, 0.0, middle]), law(&ReturnSpring, &[0.0, 0.0, 1.0, middle]));
    let id = ReturnSpring.id();
    let mut candidates = vec![
        Candidate::one(id, Kind::Plant, "k", units.per_place, spring.clone()),
        Candidate::several(id, Kind::Plant, vec![spring, harder], vec![("k", units.per_place), ("k3", units.per_cube)]),
    ];
    for (place, width) in PLACES.values().flat_map(|place| PATH_WIDTHS.values().map(move |w| (place, w))) {
        let (place, width) = (low + range * place, range * width);
        let column = law(&LocalResistance, &[1.0, place, width, 0.0]);
        let resists = Candidate::one(local_resistance::ID, Kind::Plant, "F", units.force, column).positive();
        candidates.push(resists.at("place", place, units.place).at("width", width, units.place));
    }
    let n = rows.len();
    let y = of(&|r| r.force);
    let quarter = |from: usize, to: usize| y[from..to].iter().sum::<f64>() / (to - from).max(1) as f64;
    let largest = (0..n).max_by(|a, b| y[*a].abs().total_cmp(&y[*b].abs())).unwrap_or(0);
    let falls = format!(
        "from {:.2} at {:.2} to {:.2} over the last quarter of the way, which ends at {high:.2}",
        y[largest],
        rows[largest].place,
        quarter(n - n / 4, n)
    );
    let layout = Layout::of(rows.iter().map(|r| r.recording).collect(), &vec![true; n], 1.0);
    let floor = white_noise(&y);
    let view = View { is_angular: units.is_angular, ..view(rows) };
    // The laws are functions of the place, as a structured error is: they do not compete, but the noise is learnt beside it.
    let channel = Channel::new(y, base, candidates, layout, Rules::of_observations());
    let study = beside_errors(channel, &view, &[]).fit()?;
    Ok(AlongPath { compared: compared(study, ("force along the way", units.force), floor, view), falls })
}

impl Told for AlongPath {
    fn shows(&self, found: &Found<'_>) -> String {
        match found.candidate.id {
            local_resistance::ID => {
                format!("the force goes with the place: a resistance that is passed ({})", self.falls)
            }
            return_spring::ID => format!("the force changes evenly with the place ({})", self.falls),
            other => format!("{other} shows in the force along the way"),
        }
    }
}

/// Comparison of two estimates of one force: a constant, a factor or a rotation between them.
fn second(rows: &[Row], units: &Units, names: Option<[String; 3]>) -> Result<Option<Second>, EstimateError> {
    if rows.iter().any(|r| r.second_n.is_none()) {
        return Ok(None);
    }
    let n = rows.len();
    let each = |f: &dyn Fn(&Row, usize) -> f64| {
        (0..3).flat_map(|axis| rows.iter().map(move |r| (r, axis))).map(|(r, axis)| f(r, axis)).collect::<Vec<f64>>()
    };
    let y = each(&|r, a| r.second_n.map_or(0.0, |s| s[a]) - r.measured_n[a]);
    let only = |wanted: usize| each(&|_, a| f64::from(u8::from(a == wanted)));
    let mut candidates = vec![
        Candidate::several(
            force_bias::ID,
            Kind::Instrument,
            vec![only(0), only(1), only(2)],
            vec![("bx", "N"), ("by", "N"), ("bz", "N")],
        ),
        Candidate::one(force_gain::ID, Kind::Instrument, "g - 1", "1", each(&|r, a| r.measured_n[a])),
        Candidate::one(
            force_cross_axis::ID,
            Kind::Instrument,
            "turn about z",
            "rad",
            each(&|r, a| match a {
                0 => -r.measured_n[1],
                1 => r.measured_n[0],
                _ => 0.0,
            }),
        ),
    ];
    candidates.retain(|c| c.regressors.iter().all(|v| v.iter().any(|x| *x != 0.0)));
    let floor = white_noise(&y);
    let stretch: Vec<usize> = (0..3 * n).map(|i| 1000 * (i / n) + rows[i % n].recording).collect();
    let layout = Layout::of(stretch, &vec![true; 3 * n], 1.0);
    let study = Channel::new(y, Vec::new(), candidates, layout, Rules::of_observations()).fit()?;
    let which =
        names.map_or_else(|| "the second estimate".to_owned(), |n| n[0].trim_end_matches("_N").replacen("fx_", "", 1));
    let view = View { is_angular: units.is_angular, ..view_of_both(rows) };
    Ok(Some(Second { compared: compared(study, ("difference of the two forces", "N"), floor, view), which }))
}

/// Variable that best shows a cause.
fn best_seen(id: &str) -> Variable {
    match id {
        force_gain::ID => Variable::Force,
        force_cross_axis::ID => Variable::Across,
        _ => Variable::Place,
    }
}

impl Told for Second {
    fn shows(&self, found: &Found<'_>) -> String {
        let which = &self.which;
        let value = |k: usize| found.parameters.get(k).map_or(0.0, |p| p.value);
        match found.candidate.id {
            force_bias::ID => format!(
                "the force by {which} lies ({:.1}, {:.1}, {:.1}) N beside the measured one, whatever that is",
                value(0),
                value(1),
                value(2)
            ),
            force_gain::ID => format!("the force by {which} is {:.2} times the measured one", 1.0 + value(0)),
            other => format!("{other} between the force by {which} and the measured one"),
        }
    }
}

/// The channel of a fit over all parts of the path.
fn compared(study: ChannelFit, (channel, unit): (&'static str, &'static str), floor: f64, view: View) -> Compared {
    let (along, state) = (vec![true; study.target.len()], vec![SystemState::Turning; study.target.len()]);
    Compared { study, channel, unit, floor, along, state, view }
}
