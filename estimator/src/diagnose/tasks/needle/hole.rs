//! Needle in its hole: the forces that hold its shaft.

use super::forces::{RIM_SHARE, rim};
use super::held_needle::Sliding;
use super::rows::{Needle, Phase, Row};
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::direction::blur;
use crate::diagnose::data::limits::{FILTER_REACH_S, LEAST_ROWS_OF_A_FIT, SIGNIFICANT};
use crate::diagnose::data::regression_data;
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::experiment::separation::Imagined;
use crate::diagnose::hypotheses::all::widen;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::dictionary::Dictionary;
use crate::diagnose::hypotheses::grid::Grid;
use crate::diagnose::hypotheses::regressor_cache::Columns;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{
    backlash, coulomb_friction, force_drift, force_step, friction_change, hysteresis, local_resistance, quadratic_drag,
    stribeck, viscous_friction,
};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::refinement::{Refinement, refined};
use crate::diagnose::selection::rules::{MUCH_UNSEEN, Rules};
use estimation::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use haptics::Vec2;
use haptics::law::object::{MembraneHistory, MembraneLaw};
use haptics::law::{Coordinate, Kind, Motion};

/// Causes of the candidate library that are tried in a hole. Local resistance is excluded if two fingers hold the
/// needle, because its position between their pads is not known well enough.
const POSSIBLE: [&str; 10] = [
    coulomb_friction::ID,
    viscous_friction::ID,
    quadratic_drag::ID,
    stribeck::ID,
    hysteresis::ID,
    backlash::ID,
    local_resistance::ID,
    friction_change::ID,
    force_drift::ID,
    force_step::ID,
];
/// Possible causes that need the points between the rows.
const CLOSELY: [&str; 3] = [stribeck::ID, backlash::ID, local_resistance::ID];
/// Friction of a shaft in proportion to the length in the hole. The catalogue has no law for it, and every needle shows
/// it.
const ALONG_THE_SHAFT: &str = "other:depth sgn(v)";
/// Step sizes of the refinement around the values found: those of the first grid, and half of them.
/// Choice: halved or doubled, none of 14 answers changes.
const HOLE_REFINEMENT: Axis = Axis::geometric(1.0, 0.5, 2);
/// The comparison.
pub struct Shaft<'a> {
    pub compared: Compared,
    /// Content of the base model, in words.
    pub model: &'static str,
    /// Dry friction of a first fit, N.
    dry_n: f64,
    pub sliding: Sliding<'a>,
}

impl Shaft<'_> {
    /// Predicted regressors on rows that have not been measured yet.
    pub fn imagined(&self, needle: &Needle, law: Option<&MembraneLaw>) -> Imagined {
        let rows = rows(needle);
        let track = seen(needle, &rows);
        let candidates = candidates((needle, &rows), &track, law, (self.dry_n, &Grid::coarse(&track)));
        Imagined::of(base(needle, &rows, law), candidates, rows.iter().map(|r| r.stretch).collect())
    }
}

impl Told for Shaft<'_> {
    fn states(&self, _: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        widen(candidate.id, &mut found, &self.sliding.track);
        found
    }

    fn shows(&self, found: &Found<'_>) -> String {
        match found.candidate.id {
            coulomb_friction::ID => {
                "in the hole the force turns round with the direction, whatever the speed".to_owned()
            }
            viscous_friction::ID => "in the hole the force follows the speed".to_owned(),
            hysteresis::ID => "at each reversal in the hole the rim gives before the shaft slides".to_owned(),
            backlash::ID => "after each reversal in the hole nothing holds the shaft for a way".to_owned(),
            stribeck::ID => "in the hole the friction falls with speed".to_owned(),
            local_resistance::ID => {
                "at one place in the hole the shaft is held more than elsewhere, whichever way it goes".to_owned()
            }
            ALONG_THE_SHAFT => {
                "the friction grows with the length that is in the hole, which no known cause does".to_owned()
            }
            friction_change::ID => "the shaft rubs differently from one insertion to the next".to_owned(),
            other => format!("{other} shows in the force on the shaft"),
        }
    }

    fn hidden_by(&self, candidate: &Candidate) -> Option<&'static str> {
        Some(match candidate.id {
            stribeck::ID => "the needle hardly moved slowly in the hole; go to and fro there slowly and fast",
            backlash::ID => "the shaft turned round too seldom in the hole, or rubs too little, to show a gap",
            hysteresis::ID => "the shaft turned round too seldom in the hole, or rubs too little, to show a bend",
            _ => return None,
        })
    }
}

/// Rows in the hole. If the path reverses within a filter's window, the force is a mixture of both directions, whose
/// shares only the points between the rows tell. Without these points such rows are left out.
fn rows(needle: &Needle) -> Vec<Row> {
    let told = |r: &Row| if needle.fine.is_empty() { !turns(needle, r) } else { r.span.len > 0 };
    needle.rows.iter().filter(|r| r.phase == Phase::Hole && told(r)).copied().collect()
}

/// True if the path may reverse within a filter's window around a row.
fn turns(needle: &Needle, row: &Row) -> bool {
    row.rate_m_s.abs() < FILTER_REACH_S * row.acceleration_m_s2.abs() + SIGNIFICANT * needle.rate_noise_m_s
}

/// The same rows as a track, with the uncertainty of their direction.
fn seen(needle: &Needle, rows: &[Row]) -> Track {
    let mut track = track(needle, rows);
    blur(&mut track);
    track
}

/// Regressors of the base model: held weight in every hold, the needle's mass, and a world's friction.
fn base(needle: &Needle, rows: &[Row], law: Option<&MembraneLaw>) -> Vec<Vec<f64>> {
    let of = |f: &dyn Fn(usize) -> f64| (0..rows.len()).map(f).collect::<Vec<f64>>();
    let mut base: Vec<Vec<f64>> = (0..needle.holds).map(|h| of(&|i| f64::from(u8::from(rows[i].hold == h)))).collect();
    if needle.two_fingered {
        // Mass of the needle. A tool's sensor carries no mass in front of it.
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
    (dry_n, grid): (f64, &Grid),
) -> Vec<Candidate> {
    let of = |f: &dyn Fn(usize) -> f64| (0..rows.len()).map(f).collect::<Vec<f64>>();
    let direction = of(&|i| track.rows[i].motion.direction);
    let resisting: Vec<f64> = direction.iter().map(|d| dry_n * d).collect();
    let dictionary = Dictionary {
        track,
        predicted: &resisting,
        resisting: &resisting,
        dry: &vec![dry_n; direction.len()],
        fixed: &[],
        without: &[],
        grid,
        columns: &Columns::default(),
    };
    // A push at a place, in either direction, is the rim of the sheet.
    let pushes = |c: &Candidate| c.id == local_resistance::ID && (c.sign == 0.0 || needle.two_fingered);
    // Motion within a filter's window at a reversal is known only between the rows.
    let unseen = |c: &Candidate| needle.joined && CLOSELY.contains(&c.id);
    let possible = dictionary.candidates().into_iter().filter(|c| POSSIBLE.contains(&c.id) && !pushes(c) && !unseen(c));
    // A rate is measured less well than a direction.
    let with_noise = |c: Candidate| {
        if c.id == viscous_friction::ID { c.noisy(needle.slope_noise_m_s) } else { c }
    };
    let mut candidates: Vec<Candidate> = possible.map(with_noise).collect();
    if law.is_some() {
        // The world's law already bends before it slides.
        candidates.retain(|c| ![hysteresis::ID, coulomb_friction::ID, viscous_friction::ID].contains(&c.id));
    }
    let longer = of(&|i| rows[i].depth_m * direction[i]);
    candidates.push(Candidate::one(ALONG_THE_SHAFT, Kind::Plant, "A", "N/m", longer).positive());
    for push in 1..=rows.iter().map(|r| r.push).max().unwrap_or(0) {
        let later = of(&|i| if rows[i].push >= push { dry_n * direction[i] } else { 0.0 });
        if rows.iter().any(|r| r.push < push) {
            let change = Candidate::one(friction_change::ID, Kind::Plant, "relative change", "1", later);
            candidates.push(change.at("from insertion", (push + 1) as f64, "1"));
        }
    }
    candidates
}

/// Compares the causes that may hold the shaft. `None` if the needle hardly moved in a hole.
pub fn shaft<'a>(
    needle: &'a Needle,
    law: Option<&'a MembraneLaw>,
    rules: Rules,
) -> Result<Option<Shaft<'a>>, EstimateError> {
    let rows = rows(needle);
    // Reversals alone cannot separate presliding from friction, nor determine the size of either.
    if rows.iter().filter(|r| !turns(needle, r)).count() < LEAST_ROWS_OF_A_FIT {
        return Ok(None);
    }
    let track = seen(needle, &rows);
    let y: Vec<f64> = rows.iter().map(|r| r.force_n).collect();
    let base = base(needle, &rows, law);
    let direction: Vec<f64> = track.rows.iter().map(|r| r.motion.direction).collect();
    let mut first = base.clone();
    first.push(direction.clone());
    let look = least_squares(&first, &y, None)?;
    // With a world's law, the last but one regressor of the base is its friction.
    let of_world = if law.is_some() { look.values[base.len() - 2].abs() } else { 0.0 };
    let dry_n = look.values[first.len() - 1].abs() + of_world;
    // An uncertain direction makes all of the friction uncertain.
    let floor_n = white_noise(&y);
    let open = |r: &regression_data::Row| {
        (1.0 + dry_n * dry_n * r.open / (floor_n * floor_n).max(f64::MIN_POSITIVE)).powf(-0.5)
    };
    let weight = track.rows.iter().map(open).collect();
    let stretch: Vec<usize> = rows.iter().map(|r| r.stretch).collect();
    let along: Vec<bool> = (0..rows.len()).map(|i| i % 2 == 0).collect();
    let state = rows.iter().map(Row::state).collect();
    let asked = |grid: &Grid, dry_n: f64| candidates((needle, &rows), &track, law, (dry_n, grid));
    let layout = Layout::of(stretch, &along, needle.period_s).weighted(weight);
    let rules = Rules { much: Some(MUCH_UNSEEN), ..rules.with_friction(law.is_some()) };
    let view = super::sheet::view(&rows);
    let channel = beside_errors(Channel::new(y, base, Vec::new(), layout, rules), &view, &[Variable::Velocity]);
    let grid = Grid::coarse(&track);
    let mut closer = Closer { channel, track: &track, asked: &asked, grid, first_n: dry_n, dry_n };
    let study = settle(refined(&mut closer, HOLE_REFINEMENT.values().count())?);
    let beside_n = closer.dry_n;
    let dry_n = sliding_n(&study).unwrap_or(dry_n);
    let model = if law.is_some() { "friction of the hole" } else { "nothing in the hole" };
    let sliding = Sliding { needle, law, rows, track, dry_n: beside_n };
    let compared = Compared { study, channel: "force on the shaft", unit: "N", floor: floor_n, along, state, view };
    Ok(Some(Shaft { compared, model, dry_n, sliding }))
}

/// The comparison over grids around the values found.
struct Closer<'a> {
    channel: Channel,
    track: &'a Track,
    /// Candidates over a grid, for a dry friction, N.
    asked: &'a dyn Fn(&Grid, f64) -> Vec<Candidate>,
    grid: Grid,
    /// Dry friction of a first fit, and that to which the shares of this round refer, N.
    first_n: f64,
    dry_n: f64,
}

impl Refinement for Closer<'_> {
    fn compare(&mut self, _: Option<ChannelFit>) -> Result<ChannelFit, EstimateError> {
        Channel { candidates: (self.asked)(&self.grid, self.dry_n), ..self.channel.clone() }.fit()
    }

    fn close_in(&mut self, study: &ChannelFit, round: usize) -> bool {
        let picks = study.picks();
        let found: Vec<&Candidate> =
            picks.iter().map(|p| &study.candidates[*p]).filter(|c| !c.searched.is_empty()).collect();
        let Some(step) = HOLE_REFINEMENT.values().nth(round).filter(|_| !found.is_empty()) else { return false };
        self.grid = std::mem::take(&mut self.grid).with(Grid::around(&found, self.track, step));
        // Backlash takes much of it away in a first fit; its share refers to the friction of sliding.
        self.dry_n = sliding_n(study).unwrap_or(self.first_n);
        true
    }
}

/// Estimated dry friction, N.
fn sliding_n(study: &ChannelFit) -> Option<f64> {
    study.found().into_iter().find(|(c, _)| c.id == coulomb_friction::ID).map(|(_, values)| values[0])
}

/// Friction of a world's hole along the measured path, N, without drag.
fn held(law: &MembraneLaw, rows: &[Row]) -> Vec<f64> {
    let law = rim(law);
    let mut history = MembraneHistory::default();
    let mut push = None;
    rows.iter()
        .map(|row| {
            if push != Some(row.push) {
                push = Some(row.push);
                history = MembraneHistory::default();
            }
            law.force_n(row.depth_m.max(f64::MIN_POSITIVE), row.rate_m_s, &mut history)
        })
        .collect()
}

fn track(needle: &Needle, rows: &[Row]) -> Track {
    let start_s = rows.first().map_or(0.0, |r| r.time_s);
    let along = rows
        .iter()
        .map(|r| regression_data::Row {
            segment: r.stretch,
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
            target: r.force_n,
            span: r.span,
            ..regression_data::Row::default()
        })
        .collect();
    Track {
        rows: along,
        fine: needle.fine.iter().map(|p| regression_data::Fine { time_s: p.time_s - start_s, ..*p }).collect(),
        period_s: needle.period_s,
        raw_period_s: needle.period_s,
        velocity_noise: if needle.fine.is_empty() { needle.rate_noise_m_s } else { needle.slope_noise_m_s },
        span_s: rows.last().map_or(0.0, |r| r.time_s) - start_s,
        ..Track::of(Coordinate::Linear)
    }
}
