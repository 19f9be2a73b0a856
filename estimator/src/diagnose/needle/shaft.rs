//! The needle in its hole: what holds its shaft.

use super::rows::{Needle, Phase, Row};
use crate::diagnose::answer::{Compared, Found};
use crate::diagnose::atlas::View;
use crate::diagnose::blur::blur;
use crate::diagnose::candidate::Candidate;
use crate::diagnose::columns::Columns;
use crate::diagnose::compare::Channel;
use crate::diagnose::dictionary::Dictionary;
use crate::diagnose::experiment::Imagined;
use crate::diagnose::grid::Grid;
use crate::diagnose::track::{self, Bearing, Track};
use crate::estimate::EstimateError;
use crate::identify::linear::least_squares;
use crate::signal::noise::white_noise;
use haptics::Vec2;
use haptics::law::object::{MembraneHistory, MembraneLaw};
use haptics::law::{Coordinate, Kind, Motion};

/// Fewer rows in a hole show nothing.
const LEAST_ROWS: usize = 60;
/// Half of the filter's window, with some room, s, and how clear a direction must be.
const WINDOW_S: f64 = 0.018;
const NOISES: f64 = 3.0;
/// Causes of the dictionary that are asked for in a hole. Where it rubs more than elsewhere, and what bends its friction with speed, is
/// not: the place of a needle between two pads is not known well enough for that.
const POSSIBLE: [&str; 6] =
    ["coulomb-friction", "viscous-friction", "quadratic-drag", "hysteresis", "friction-change", "force-drift"];
/// The rim of a world's hole may be softer or stiffer than its sheet by so much, in a first step.
const RIM_SHARE: f64 = 0.05;

/// The comparison.
pub struct Shaft {
    pub compared: Compared,
    /// What its rows are seen against.
    pub view: View,
    /// What the model without a cause has.
    pub model: &'static str,
    /// Dry friction at a first look, N.
    dry_n: f64,
}

impl Shaft {
    /// The columns on rows that were not measured yet.
    pub fn imagined(&self, needle: &Needle, law: Option<&MembraneLaw>) -> Imagined {
        let rows = rows(needle);
        let track = seen(needle, &rows);
        Imagined {
            base: base(needle, &rows, law),
            candidates: candidates((needle, &rows), &track, law, self.dry_n),
            stretch: rows.iter().map(|r| r.stretch).collect(),
            weight: vec![1.0; rows.len()],
        }
    }
}

/// Rows in the hole. Where the way turns round within a filter's window the force is of both directions.
fn rows(needle: &Needle) -> Vec<Row> {
    let turns = |r: &Row| r.rate_m_s.abs() < WINDOW_S * r.acceleration_m_s2.abs() + NOISES * needle.rate_noise_m_s;
    needle.rows.iter().filter(|r| r.phase == Phase::Hole && !turns(r)).copied().collect()
}

/// The same as a track, as certain of its direction as it can be.
fn seen(needle: &Needle, rows: &[Row]) -> Track {
    let mut track = track(needle, rows);
    blur(&mut track);
    track
}

/// What is held in every hold, the needle's mass, and a world's friction.
fn base(needle: &Needle, rows: &[Row], law: Option<&MembraneLaw>) -> Vec<Vec<f64>> {
    let of = |f: &dyn Fn(usize) -> f64| (0..rows.len()).map(f).collect::<Vec<f64>>();
    let mut base: Vec<Vec<f64>> = (0..needle.holds).map(|h| of(&|i| f64::from(u8::from(rows[i].hold == h)))).collect();
    if needle.two_fingered {
        // The needle's own mass; a tool's sensor sits behind none.
        base.push(of(&|i| rows[i].acceleration_m_s2));
    }
    if let Some(law) = law {
        let friction = held(law, rows);
        let stiffer = MembraneLaw { stiffness_n_m: (1.0 + RIM_SHARE) * law.stiffness_n_m, ..*law };
        base.push(held(&stiffer, rows).iter().zip(&friction).map(|(s, f)| s - f).collect());
        base.push(friction);
        base.push(of(&|i| rows[i].rate_m_s));
    }
    base
}

fn candidates(
    (needle, rows): (&Needle, &[Row]),
    track: &Track,
    law: Option<&MembraneLaw>,
    dry_n: f64,
) -> Vec<Candidate> {
    let of = |f: &dyn Fn(usize) -> f64| (0..rows.len()).map(f).collect::<Vec<f64>>();
    let direction = of(&|i| track.rows[i].motion.direction);
    let resisting: Vec<f64> = direction.iter().map(|d| dry_n * d).collect();
    let grid = Grid::coarse(track);
    let dictionary = Dictionary {
        track,
        predicted: &resisting,
        resisting: &resisting,
        dry: &vec![dry_n; direction.len()],
        fixed: &[],
        without: &[],
        grid: &grid,
        columns: &Columns::default(),
    };
    let possible = dictionary.candidates().into_iter().filter(|c| POSSIBLE.contains(&c.id));
    // A rate is measured less well than a direction.
    let with_noise = |c: Candidate| {
        if c.id == "viscous-friction" { c.noisy(needle.slope_noise_m_s) } else { c }
    };
    let mut candidates: Vec<Candidate> = possible.map(with_noise).collect();
    if law.is_some() {
        // It bends before it slides already.
        candidates.retain(|c| !["hysteresis", "coulomb-friction", "viscous-friction"].contains(&c.id));
    }
    for push in 1..=rows.iter().map(|r| r.push).max().unwrap_or(0) {
        let later = of(&|i| if rows[i].push >= push { dry_n * direction[i] } else { 0.0 });
        if rows.iter().any(|r| r.push < push) {
            let change = Candidate::one("friction-change", Kind::Plant, "relative change", "1", later);
            candidates.push(change.at("from insertion", (push + 1) as f64, "1"));
        }
    }
    let span = track.span_s.max(1e-9);
    candidates.extend((1..=3).map(|k| {
        let wave = of(&|i| (std::f64::consts::PI * f64::from(k) * rows[i].time_s / span).cos());
        let expression = Some(format!("cos({k} pi t/T)"));
        Candidate { expression, ..Candidate::one("other", Kind::Plant, "amplitude", "", wave) }
    }));
    candidates
}

/// Compares what may hold the shaft. `None` where the needle hardly moved in a hole.
pub fn shaft(needle: &Needle, law: Option<&MembraneLaw>, threshold: f64) -> Result<Option<Shaft>, EstimateError> {
    let rows = rows(needle);
    if rows.len() < LEAST_ROWS {
        return Ok(None);
    }
    let track = seen(needle, &rows);
    let y: Vec<f64> = rows.iter().map(|r| r.force_n).collect();
    let base = base(needle, &rows, law);
    let direction: Vec<f64> = track.rows.iter().map(|r| r.motion.direction).collect();
    let mut first = base.clone();
    first.push(direction.clone());
    let look = least_squares(&first, &y, None)?;
    // Of a world's columns the last but one is its friction.
    let of_world = if law.is_some() { look.values[base.len() - 2].abs() } else { 0.0 };
    let dry_n = look.values[first.len() - 1].abs() + of_world;
    let candidates = candidates((needle, &rows), &track, law, dry_n);
    // Where the direction is a guess all of the friction is open.
    let floor_n = white_noise(&y);
    let weight = direction
        .iter()
        .map(|d| (1.0 + dry_n * dry_n * (1.0 - d * d) / (floor_n * floor_n).max(1e-18)).powf(-0.5))
        .collect();
    let stretch: Vec<usize> = rows.iter().map(|r| r.stretch).collect();
    let along: Vec<bool> = (0..rows.len()).map(|i| i % 2 == 0).collect();
    let state = rows.iter().map(Row::state).collect();
    let channel = Channel {
        y,
        base,
        candidates,
        stretch: stretch.clone(),
        testable: along.clone(),
        weight,
        period_s: needle.period_s,
    };
    let model = if law.is_some() { "friction of the hole" } else { "nothing in the hole" };
    let study = channel.compare(threshold)?;
    let compared = Compared { study, channel: "force on the shaft", unit: "N", floor: floor_n, along, stretch, state };
    Ok(Some(Shaft { compared, view: super::sheet::view(&rows), model, dry_n }))
}

/// Friction of a world's hole along the measured way, N, drag left out.
fn held(law: &MembraneLaw, rows: &[Row]) -> Vec<f64> {
    let law = MembraneLaw { drag_n_s_m: 0.0, puncture_n: 0.0, ..*law };
    let mut history = MembraneHistory::default();
    let mut push = None;
    rows.iter()
        .map(|row| {
            if push != Some(row.push) {
                push = Some(row.push);
                history = MembraneHistory::default();
            }
            law.force_n(row.depth_m.max(1e-6), row.rate_m_s, &mut history)
        })
        .collect()
}

fn track(needle: &Needle, rows: &[Row]) -> Track {
    let start_s = rows.first().map_or(0.0, |r| r.time_s);
    let along = rows
        .iter()
        .map(|r| track::Row {
            recording: 0,
            stretch: r.stretch,
            place: track::Place::Along,
            motion: Motion {
                time_s: r.time_s - start_s,
                position: r.depth_m,
                velocity: r.rate_m_s,
                acceleration: r.acceleration_m_s2,
                ..Motion::default()
            },
            angle_rad: r.depth_m,
            along: Vec2::x(),
            force: Vec2::new(r.force_n, 0.0),
            force_rate: Vec2::zeros(),
            y: r.force_n,
            span: track::Span::default(),
            open: 0.0,
        })
        .collect();
    Track {
        rows: along,
        fine: Vec::new(),
        period_s: needle.period_s,
        raw_period_s: needle.period_s,
        coordinate: Coordinate::Linear,
        radius_m: None,
        planar: false,
        velocity_noise: needle.rate_noise_m_s,
        position_noise: 0.0,
        force_noise: 1e-12,
        noise_is_measured: false,
        span_s: rows.last().map_or(0.0, |r| r.time_s) - start_s,
        hung: Vec::new(),
        bearing: Bearing::default(),
        slope: None,
        extra: Vec::new(),
        freely: None,
    }
}

/// What in the residual shows a cause.
pub fn shows(found: &Found<'_>) -> String {
    match found.candidate.id {
        "coulomb-friction" => "in the hole the force turns round with the direction, whatever the speed".to_owned(),
        "viscous-friction" => "in the hole the force follows the speed".to_owned(),
        "hysteresis" => "at each reversal in the hole the rim gives before the shaft slides".to_owned(),
        "friction-change" => "the shaft rubs differently from one insertion to the next".to_owned(),
        other => format!("{other} shows in the force on the shaft"),
    }
}
