//! Sheet before the puncture, and sensors: force over depth against a linear spring.

use super::forces::{CUBIC, HERTZ, Law, first_push_n, own_n, touches};
use super::held_needle::Pressed;
use super::rows::{Needle, Phase, Puncture, Row};
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::limits::{GAP_IN_PERIODS, SIGNIFICANT};
use crate::diagnose::experiment::separation::Imagined;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::force_step::Jumps;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{
    coulomb_friction, force_bias, force_drift, force_step, hysteresis, quadratic_drag, stiffness_hardening,
    viscous_friction,
};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::model_error::smooth::over_time;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use estimation::regression::linear::{least_squares, least_squares_values};
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use haptics::law::Kind;
use haptics::law::object::MembraneLaw;

/// Tried shares of the deepest indentation that stay as a dent.
/// Choice: halved, 3 of 15 answers change (1 to wrong); doubled, 3 of 15 answers change.
const DENTS: Axis = Axis::geometric(0.04, 0.66, 16);

/// Rows of the sheet, with the base model and all candidates.
pub struct Columns {
    rows: Vec<Row>,
    floor_n: f64,
    base: Vec<Vec<f64>>,
    candidates: Vec<Candidate>,
}

impl Columns {
    /// The same as predicted rows.
    pub fn imagined(self) -> Imagined {
        Imagined::of(self.base, self.candidates, self.rows.iter().map(|r| r.stretch).collect())
    }
}

/// Corrects depths for an inclination of a recording's sheet to the needle's axis, if it is significant. The axis is
/// known from forces to a few thousandths, so each place has a slightly different surface. Places are pushed at
/// different speeds, so the error would look like drag.
fn square(needle: &Needle, recording: usize, rows: &mut [Row]) {
    let met = |r: &Row| r.recording == recording && touches(r);
    let sides = rows.iter().filter(|r| met(r)).map(|r| r.side_m);
    let (low, high) = sides.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)));
    let middle_m = 0.5 * (low + high);
    if high - low > needle.at_surface_m
        && let Some(slope) = slope_across(needle, rows.iter().filter(|r| r.recording == recording), middle_m)
    {
        for row in rows.iter_mut().filter(|r| met(r)) {
            let nearer_m = slope * (row.side_m - middle_m);
            (row.depth_m, row.deepest_m) = (row.depth_m - nearer_m, row.deepest_m - nearer_m);
        }
    }
}

/// Inclination of the sheet: rise of its surface per metre across the needle's axis. `None` if it is within its error.
fn slope_across<'a>(needle: &Needle, rows: impl Iterator<Item = &'a Row>, middle_m: f64) -> Option<f64> {
    let rows: Vec<&Row> = rows.filter(|r| r.phase != Phase::Unloading).collect();
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(|r| f(r)).collect::<Vec<f64>>();
    let pressed = |of: &dyn Fn(&Row) -> f64, r: &Row| if touches(r) { of(r) } else { 0.0 };
    let k = needle.stiffness_n_m;
    let mut columns = vec![of(&|r| pressed(&|r| -k * (r.side_m - middle_m), r))];
    columns.push(of(&|r| pressed(&|_| 1.0, r)));
    columns.push(of(&|r| pressed(&|r| r.depth_m, r)));
    columns.push(of(&|r| Law::Power(3.0).unit_n(r, &|x| x, 0.0)));
    columns.push(of(&|r| r.time_s - r.start_s));
    columns.extend((0..needle.holds).map(|h| of(&|r| f64::from(u8::from(r.phase != Phase::Empty && r.hold == h)))));
    let fit = least_squares(&columns, &of(&|r| r.force_n), None).ok()?;
    (fit.identified[0] && fit.values[0].abs() > SIGNIFICANT * fit.std_errors[0]).then_some(fit.values[0])
}

/// Columns of what the sheet may be beside a linear spring (or the law of a world), and of what may be wrong with the
/// force.
pub fn columns(needle: &Needle, law: Option<&MembraneLaw>) -> Columns {
    let mut rows: Vec<Row> = needle.rows.iter().filter(|r| r.phase != Phase::Hole).copied().collect();
    let floor_n = white_noise(&rows.iter().map(|r| r.force_n).collect::<Vec<f64>>());
    (0..needle.recordings).for_each(|recording| square(needle, recording, &mut rows));
    shuffle(&mut rows);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let is_held = |r: &Row| r.phase != Phase::Empty;
    let elastic = |x: f64| first_push_n(needle.stiffness_n_m, law, x);
    let mut base: Vec<Vec<f64>> =
        (0..needle.holds).map(|h| of(&|r| f64::from(u8::from(is_held(r) && r.hold == h)))).collect();
    base.push(of(&|r| own_n(law, r)));
    if needle.two_fingered {
        // Mass of the needle. A tool's sensor carries no mass in front of it.
        base.push(of(&|r| if is_held(r) { r.acceleration_m_s2 } else { 0.0 }));
    }
    // Surface position to first order: each recording detected it by itself.
    let owned = |k: usize, r: &Row| f64::from(u8::from(r.recording == k));
    base.extend((0..needle.recordings).map(|k| of(&|r| if touches(r) { owned(k, r) } else { 0.0 })));
    let mut candidates = candidates(needle, &rows, law, &elastic);
    candidates.extend(jumps(&rows).candidates(&force_step::ALONG, &base, &of(&|r| r.force_n)));
    Columns { rows, floor_n, base, candidates }
}

/// The rows as those in which the sensor's zero may have jumped.
fn jumps(rows: &[Row]) -> Jumps<impl Fn(&str, usize) -> f64> {
    Jumps {
        recording: rows.iter().map(|r| r.recording).collect(),
        time_s: rows.iter().map(|r| r.time_s - r.start_s).collect(),
        share: |_: &str, _| 1.0,
    }
}

fn candidates(
    needle: &Needle,
    rows: &[Row],
    law: Option<&MembraneLaw>,
    elastic: &dyn Fn(f64) -> f64,
) -> Vec<Candidate> {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let owned = |k: usize, r: &Row| f64::from(u8::from(r.recording == k));
    let give = law.map_or(0.0, |l| l.give);
    let acts = |law: Law, id, name, unit| {
        Candidate::one(id, Kind::Plant, name, unit, of(&|r| law.unit_n(r, elastic, give))).positive()
    };
    let mut candidates = vec![
        acts(Law::Power(3.0), stiffness_hardening::ID, CUBIC, "N/m³"),
        acts(Law::Power(1.5), stiffness_hardening::ID, HERTZ, "N/m^1.5"),
        acts(Law::Drag, viscous_friction::ID, "c", "N s/m"),
        Candidate::one(force_bias::ID, Kind::Instrument, "b", "N", of(&|_| 1.0)),
    ];
    // A sensor is zeroed before each recording.
    candidates.extend((0..needle.recordings).map(|k| {
        let since = of(&|r| owned(k, r) * (r.time_s - r.start_s));
        let drift = Candidate::one(force_drift::ID, Kind::Instrument, "rate", "N/s", since);
        if needle.recordings > 1 { drift.at("recording", (k + 1) as f64, "1") } else { drift }
    }));
    for dent in DENTS.values() {
        candidates.push(acts(Law::Dent(dent), hysteresis::ID, "share", "1").at("dent", dent, "1"));
    }
    if law.is_some_and(|l| l.give > 0.0) {
        candidates.retain(|c| c.id != hysteresis::ID);
    }
    candidates
}

/// The comparison.
pub struct Sheet<'a> {
    pub compared: Compared,
    /// Free-run model of a needle outside and on the sheet.
    pub pressed: Pressed<'a>,
}

impl Told for Sheet<'_> {
    fn states(&self, _: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        if candidate.id == force_step::ID {
            jumps(&self.pressed.rows).widen(candidate, &mut found);
        }
        found
    }

    fn shows(&self, found: &Found<'_>) -> String {
        match found.candidate.id {
            stiffness_hardening::ID => "the deeper the sheet is pressed the steeper its force rises".to_owned(),
            hysteresis::ID => "the sheet presses back less on the way out than on the way in: a dent stays".to_owned(),
            viscous_friction::ID => "the force on the sheet follows the speed".to_owned(),
            force_bias::ID => "empty fingers feel a force along the needle".to_owned(),
            force_drift::ID => "the force of the needle outside the sheet goes with time".to_owned(),
            force_step::ID => "the force of the needle outside the sheet jumps".to_owned(),
            other => format!("{other} shows in the force on the sheet"),
        }
    }

    fn hidden_by(&self, candidate: &Candidate) -> Option<&'static str> {
        Some(match candidate.id {
            stiffness_hardening::ID if candidate.linear[0].0 == "k3" => "the sheet was hardly pressed in",
            hysteresis::ID => "the needle was never drawn back before it went through; push, draw back and push on",
            viscous_friction::ID => "the sheet was pressed at one speed; push slowly and fast",
            force_bias::ID => {
                "the needle was held all the time: a bias passes for its weight; start with empty fingers"
            }
            force_drift::ID => "the needle was outside the sheet too briefly at one end of the recording",
            _ => return None,
        })
    }
}

/// Variable that best shows a cause on a needle.
pub fn best_seen(id: &str) -> Variable {
    match id {
        stiffness_hardening::ID | hysteresis::ID => Variable::Depth,
        viscous_friction::ID | coulomb_friction::ID | quadratic_drag::ID => Variable::Velocity,
        _ => Variable::Time,
    }
}

/// Compares them.
pub fn sheet<'a>(needle: &'a Needle, law: Option<&'a MembraneLaw>, rules: Rules) -> Result<Sheet<'a>, EstimateError> {
    let Columns { rows, floor_n, base, candidates } = columns(needle, law);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let y = of(&|r| r.force_n);
    let along: Vec<bool> = (0..rows.len()).map(|i| i % 2 == 0).collect();
    let stretch: Vec<usize> = rows.iter().map(|r| r.stretch).collect();
    let weight = vec![said_by_a_row(needle, &rows, &base, &candidates)?; y.len()];
    let layout = Layout::of(stretch, &along, needle.period_s).weighted(weight);
    let (channel, state) = ("force outside and on the sheet", rows.iter().map(Row::state).collect());
    let view = View {
        // Rows on the sheet are apart from those of empty fingers.
        sensor: rows.iter().map(|r| usize::from(touches(r))).collect(),
        ..view(&rows)
    };
    let beside = beside_errors(Channel::new(y, base, candidates, layout, rules), &view, &[Variable::Depth]);
    let study = settle(beside.fit()?);
    let compared = Compared { study, channel, unit: "N", floor: floor_n, along, state, view };
    Ok(Sheet { compared, pressed: Pressed { needle, law, rows } })
}

/// Weight of a row in the comparison, 1 for white noise. The rows are dealt out, so that whitening does not remove
/// noise that is correlated between rows, and each row has less information. Estimated outside the sheet, from the
/// residual after slow changes.
fn said_by_a_row(
    needle: &Needle,
    rows: &[Row],
    base: &[Vec<f64>],
    candidates: &[Candidate],
) -> Result<f64, EstimateError> {
    let free: Vec<usize> = (0..rows.len()).filter(|i| !touches(&rows[*i])).collect();
    let drifts = candidates.iter().filter(|c| c.id == force_drift::ID).flat_map(|c| &c.regressors).map(|c| &**c);
    let times: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
    let slow = over_time(&times, f64::INFINITY, 1.0, 3);
    let here = |column: &Vec<f64>| free.iter().map(|i| column[*i]).collect::<Vec<f64>>();
    let mut columns: Vec<Vec<f64>> = base.iter().chain(drifts).chain(&slow).map(here).collect();
    columns.retain(|column| column.iter().any(|v| *v != 0.0));
    let y: Vec<f64> = free.iter().map(|i| rows[*i].force_n).collect();
    if y.len() < 2 * columns.len() {
        return Ok(1.0);
    }
    let fit = least_squares_values(&columns, &y, None)?;
    let left = |k: usize| y[k] - columns.iter().zip(&fit.values).map(|(c, v)| c[k] * v).sum::<f64>();
    let mut in_time: Vec<(f64, f64)> = free.iter().enumerate().map(|(k, i)| (rows[*i].time_s, left(k))).collect();
    in_time.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Correlation of rows at this distance, and number of pairs.
    let correlation = |lag: usize| {
        let near = |run: &&[(f64, f64)]| run[lag].0 - run[0].0 < (lag as f64 + GAP_IN_PERIODS - 1.0) * needle.period_s;
        let pairs = in_time.windows(lag + 1).filter(near).map(|run| (run[0].1, run[lag].1));
        let sums = pairs.fold((0.0, 0.0, 0.0_f64), |(product, square, n), (a, b)| {
            (product + a * b, square + 0.5 * (a * a + b * b), n + 1.0)
        });
        (if sums.1 > 0.0 { sums.0 / sums.1 } else { 0.0 }, sums.2)
    };
    let ((first, pairs), (second, _)) = (correlation(1), correlation(2));
    // Inflation of a mean's error over many rows: white noise plus noise with an exponential autocorrelation.
    let share = (second / first.max(1e-9)).clamp(first.clamp(0.0, 0.95), 0.95);
    let is_clear = first * pairs.sqrt() > SIGNIFICANT;
    Ok(if is_clear { (1.0 + 2.0 * first / (1.0 - share)).powf(-0.5) } else { 1.0 })
}

/// Sensor reading at a puncture without the sheet, N: held weight and the sensor faults found.
pub fn level_n(study: &ChannelFit, at: &Puncture) -> f64 {
    let Some(solved) = &study.solved else { return 0.0 };
    let mut level = solved.values[at.hold];
    for (candidate, values) in study.found() {
        let own = candidate.searched.iter().all(|s| s.name != "recording" || s.value == (at.recording + 1) as f64);
        level += match candidate.id {
            force_bias::ID => values[0],
            force_drift::ID if own => values[0] * at.time_s,
            force_step::ID if candidate.part == at.recording && at.time_s >= candidate.searched[0].value => values[0],
            _ => 0.0,
        };
    }
    level
}

/// Variables of the plots of a needle's rows.
pub fn view(rows: &[Row]) -> View {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let over = vec![
        (Variable::Time, of(&|r| r.time_s - r.start_s)),
        (Variable::Depth, of(&|r| r.depth_m)),
        (Variable::Velocity, of(&|r| r.rate_m_s)),
    ];
    View { way: of(&|r| r.rate_m_s), ..View::of(rows.iter().map(|r| r.recording).collect(), over, best_seen) }
}

/// Deals the rows into segments of their own, like cards. A push lasts less than a second, so a held-out block of
/// consecutive rows would contain all of it. Rows a filter window apart are nearly uncorrelated.
fn shuffle(rows: &mut Vec<Row>) {
    /// Number of hands to which the rows are dealt.
    /// Choice: halved, 0 of 15 answers change; doubled, 2 of 15 answers change.
    const HANDS: usize = 7;
    let dealt = (0..HANDS).flat_map(|hand| rows.iter().skip(hand).step_by(HANDS).copied()).collect();
    *rows = dealt;
    rows.iter_mut().enumerate().for_each(|(k, row)| row.stretch = k);
}
