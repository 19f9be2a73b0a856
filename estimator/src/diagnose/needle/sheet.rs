//! The sheet before it is pierced, and the sensors: force over depth against a spring that is the same at every depth.

use super::rows::{Needle, Phase, Row};
use crate::diagnose::answer::{Compared, Found};
use crate::diagnose::atlas::{Variable, View};
use crate::diagnose::candidate::Candidate;
use crate::diagnose::compare::Channel;
use crate::diagnose::experiment::Imagined;
use crate::estimate::EstimateError;
use crate::signal::noise::white_noise;
use haptics::law::Kind;
use haptics::law::object::MembraneLaw;

/// Shares of the deepest insertion that may stay as a dent.
const DENTS: [f64; 16] = [0.04, 0.07, 0.1, 0.13, 0.16, 0.19, 0.22, 0.25, 0.28, 0.32, 0.36, 0.4, 0.45, 0.5, 0.58, 0.66];

/// Rows of the sheet, and everything that could explain them.
pub struct Columns {
    rows: Vec<Row>,
    floor_n: f64,
    base: Vec<Vec<f64>>,
    candidates: Vec<Candidate>,
}

impl Columns {
    /// As rows that were not measured yet.
    pub fn imagined(self) -> Imagined {
        Imagined {
            stretch: self.rows.iter().map(|r| r.stretch).collect(),
            weight: vec![1.0; self.rows.len()],
            base: self.base,
            candidates: self.candidates,
        }
    }
}

fn touches(r: &Row) -> bool {
    matches!(r.phase, Phase::Loading | Phase::Unloading) && r.depth_m > 0.0
}

/// Columns of what the sheet may be beside a linear spring (or the law of a world), and of what may be wrong with the force.
pub fn columns(needle: &Needle, law: Option<&MembraneLaw>) -> Columns {
    let mut rows: Vec<Row> = needle.rows.iter().filter(|r| r.phase != Phase::Hole).copied().collect();
    let floor_n = white_noise(&rows.iter().map(|r| r.force_n).collect::<Vec<f64>>());
    shuffle(&mut rows);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let is_held = |r: &Row| r.phase != Phase::Empty;
    let k = needle.stiffness_n_m;
    let elastic = |x: f64| law.map_or(k * x, |l| l.loading_n(x));
    let mut base: Vec<Vec<f64>> =
        (0..needle.holds).map(|h| of(&|r| f64::from(u8::from(is_held(r) && r.hold == h)))).collect();
    base.push(match law {
        Some(law) => of(&|r| if touches(r) { with_dent(law.give, r, &elastic) } else { 0.0 }),
        None => of(&|r| if touches(r) { r.depth_m } else { 0.0 }),
    });
    if needle.two_fingered {
        // The needle's own mass; a tool's sensor sits behind none.
        base.push(of(&|r| if is_held(r) { r.acceleration_m_s2 } else { 0.0 }));
    }
    // Where the surface is, to first order: each recording found it by itself.
    let owned = |k: usize, r: &Row| f64::from(u8::from(r.recording == k));
    base.extend((0..needle.recordings).map(|k| of(&|r| if touches(r) { owned(k, r) } else { 0.0 })));
    let candidates = candidates(needle, &rows, law, &elastic);
    Columns { rows, floor_n, base, candidates }
}

fn candidates(
    needle: &Needle,
    rows: &[Row],
    law: Option<&MembraneLaw>,
    elastic: &dyn Fn(f64) -> f64,
) -> Vec<Candidate> {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let pressed = |r: &Row| if touches(r) { r.depth_m } else { 0.0 };
    let owned = |k: usize, r: &Row| f64::from(u8::from(r.recording == k));
    let mut candidates = vec![
        Candidate::one("stiffness-hardening", Kind::Plant, "k3", "N/m³", of(&|r| pressed(r).powi(3))).positive(),
        Candidate::one("stiffness-hardening", Kind::Plant, "hertz", "N/m^1.5", of(&|r| pressed(r).powf(1.5)))
            .positive(),
        Candidate::one(
            "viscous-friction",
            Kind::Plant,
            "c",
            "N s/m",
            of(&|r| if touches(r) { r.rate_m_s } else { 0.0 }),
        )
        .positive(),
        Candidate::one("force-bias", Kind::Instrument, "b", "N", of(&|_| 1.0)),
    ];
    // A sensor is set to zero before each recording.
    candidates.extend((0..needle.recordings).map(|k| {
        let since = of(&|r| owned(k, r) * (r.time_s - r.start_s));
        let drift = Candidate::one("force-drift", Kind::Instrument, "rate", "N/s", since);
        if needle.recordings > 1 { drift.at("recording", (k + 1) as f64, "1") } else { drift }
    }));
    for dent in DENTS {
        let less = of(&|r| if touches(r) { with_dent(dent, r, elastic) - elastic(r.depth_m) } else { 0.0 });
        let cause = Candidate::one("hysteresis", Kind::Plant, "share", "1", less).positive();
        candidates.push(cause.at("dent", dent, "1"));
    }
    if law.is_some_and(|l| l.give > 0.0) {
        candidates.retain(|c| c.id != "hysteresis");
    }
    let span = rows.iter().map(|r| r.time_s).fold(0.0, f64::max).max(1e-9);
    let term = |expression: &str, column: Vec<f64>| Candidate {
        expression: Some(expression.to_owned()),
        ..Candidate::one("other", Kind::Plant, "amplitude", "", column)
    };
    // A curve of another form still: it keeps the whitening honest.
    candidates.push(term("x²", of(&|r| pressed(r).powi(2))));
    candidates.extend((1..=3).map(|n| {
        let wave = of(&|r| (std::f64::consts::PI * f64::from(n) * r.time_s / span).cos());
        term(&format!("cos({n} pi t/T)"), wave)
    }));
    candidates
}

/// Compares them.
pub fn sheet(needle: &Needle, law: Option<&MembraneLaw>, threshold: f64) -> Result<(Compared, View), EstimateError> {
    let Columns { rows, floor_n, base, candidates } = columns(needle, law);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let y = of(&|r| r.force_n);
    let along: Vec<bool> = (0..rows.len()).map(|i| i % 2 == 0).collect();
    let stretch: Vec<usize> = rows.iter().map(|r| r.stretch).collect();
    let weight = vec![1.0; y.len()];
    let channel = Channel {
        y,
        base,
        candidates,
        stretch: stretch.clone(),
        testable: along.clone(),
        weight,
        period_s: needle.period_s,
    };
    let study = channel.compare(threshold)?;
    let (channel, state) = ("force outside and on the sheet", rows.iter().map(Row::state).collect());
    let compared = Compared { study, channel, unit: "N", floor: floor_n, along, stretch, state };
    let view = View {
        // What presses the sheet says nothing of empty fingers.
        sensor: rows.iter().map(|r| usize::from(touches(r))).collect(),
        ..view(&rows)
    };
    Ok((compared, view))
}

/// What rows of a needle are seen against.
pub fn view(rows: &[Row]) -> View {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let over = vec![
        (Variable::Time, of(&|r| r.time_s - r.start_s)),
        (Variable::Depth, of(&|r| r.depth_m)),
        (Variable::Velocity, of(&|r| r.rate_m_s)),
    ];
    View { way: of(&|r| r.rate_m_s), ..View::of(rows.iter().map(|r| r.recording).collect(), over) }
}

/// What a cause on a needle is best seen against.
pub fn best_seen(id: &str) -> Variable {
    match id {
        "stiffness-hardening" | "hysteresis" => Variable::Depth,
        "viscous-friction" | "coulomb-friction" | "quadratic-drag" => Variable::Velocity,
        _ => Variable::Time,
    }
}

/// A push is over within a second: rows that are held out in blocks would take all of one. Rows a filter window apart hardly hang
/// together, so they are dealt out like cards, each a stretch of its own.
fn shuffle(rows: &mut Vec<Row>) {
    /// Hands that the rows are dealt to.
    const HANDS: usize = 7;
    let dealt = (0..HANDS).flat_map(|hand| rows.iter().skip(hand).step_by(HANDS).copied()).collect();
    *rows = dealt;
    rows.iter_mut().enumerate().for_each(|(k, row)| row.stretch = k);
}

/// A sheet that keeps a share of its deepest insertion as a dent: below the deepest place it is steeper, and lower.
fn with_dent(share: f64, row: &Row, elastic: &dyn Fn(f64) -> f64) -> f64 {
    let (x, deepest) = (row.depth_m, row.deepest_m);
    if row.phase == Phase::Loading || x >= deepest {
        return elastic(x);
    }
    let dent = share * deepest;
    elastic(deepest) * ((x - dent) / (deepest - dent).max(1e-9)).max(0.0)
}

/// What in the residual shows a cause.
pub fn shows(found: &Found<'_>) -> String {
    match found.candidate.id {
        "stiffness-hardening" => "the deeper the sheet is pressed the steeper its force rises".to_owned(),
        "hysteresis" => "the sheet presses back less on the way out than on the way in: a dent stays".to_owned(),
        "viscous-friction" => "the force on the sheet follows the speed".to_owned(),
        "force-bias" => "empty fingers feel a force along the needle".to_owned(),
        "force-drift" => "the force of the needle outside the sheet goes with time".to_owned(),
        other => format!("{other} shows in the force on the sheet"),
    }
}

/// Sizes that could just matter, and what would show them.
pub fn usual(candidate: &Candidate) -> Option<(f64, &'static str)> {
    Some(match candidate.id {
        "stiffness-hardening" if candidate.linear[0].0 == "k3" => (5e5, "the sheet was hardly pressed in"),
        "hysteresis" => (1.0, "the needle was never drawn back before it went through; push, draw back and push on"),
        "viscous-friction" => (2.0, "the sheet was pressed at one speed; push slowly and fast"),
        "force-bias" => {
            (0.01, "the needle was held all the time: a bias passes for its weight; start with empty fingers")
        }
        "force-drift" => (0.01 / 10.0, "the needle was outside the sheet too briefly at one end of the recording"),
        _ => return None,
    })
}
