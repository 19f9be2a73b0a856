//! Needles that go through a sheet with a structure or an effect in it.

use super::family::{Family, Group};
use super::needle_effect::Kind;
use super::scale::{rms_beside, scaled};
use super::sensor::{ErringSensor, Moment};
use super::sets::{Job, Made};
use super::structure::Structure;
use crate::tasks::Case;
use crate::tasks::needle::plan;
use crate::tasks::sheet::{NOISE_N, Plan, Sheet, Stroke, perform_with};
use blind::Chance;
use blind::lag::Creep;
use estimator::diagnose::Options;
use haptics::law::object::MembraneLaw;
use haptics::recording::Recording;
use haptics::world::{World, presets};

/// Fine steps between two rows of a measured size.
///
/// Derived: 50 µs · 20 = 1 ms, the densest rows of a recording.
const EVERY: usize = 20;
/// A force of the tissue grows to its size within this depth, m: nothing jumps when a needle touches.
///
/// Choice: a sixth of the shallowest puncture, about the finest field.
const RAMP_M: f64 = 0.5e-3;

/// A sheet, the way of the tool, and what is known of it.
struct Object {
    sheet: Sheet,
    plan: Plan,
    options: Options,
    seed: u64,
}

/// Hidden structure; hidden effect with its size, and the sign of a drift.
#[derive(Clone, Copy, Default)]
struct Hidden {
    structure: Option<Structure>,
    effect: Option<(Kind, f64, f64)>,
}

/// One row of a performance.
#[derive(Clone, Copy, Debug)]
struct Row {
    time_s: f64,
    depth_m: f64,
    is_pierced: bool,
    /// True force without the structure, and what the structure adds to the reading, N.
    force_n: f64,
    wrong_n: f64,
}

/// A case of a job, and the same without its structure.
pub fn make(job: &Job) -> Made {
    let object = drawn(job);
    let mut chance = Chance::new(job.seed, 62);
    let structure = Structure::drawn(job.family, job.form, Group::Needles, &mut chance);
    let sign = chance.sign();
    let effect = job.needle_effect.map(|kind| (kind, kind.first_size(&object.sheet), sign));
    let hidden = Hidden { structure: Some(structure), effect };
    let limited = |k: usize, size: f64| match effect {
        Some((kind, ..)) if k > 0 => kind.limited(size),
        _ => structure.limited(size),
    };
    let mut first = vec![structure.size];
    first.extend(effect.map(|(_, size, _)| size));
    let done = scaled(&first, &job.ratios, &limited, &mut |sizes| ratios(&object, &with_sizes(&hidden, sizes)));
    let hidden = with_sizes(&hidden, &done.sizes);
    let case = |hidden: &Hidden| {
        let (recording, _) = run(&object, hidden, 63);
        Case { recordings: vec![recording], options: object.options.clone() }
    };
    Made { case: case(&hidden), clean: case(&Hidden { structure: None, ..hidden }), scaled: done, noise_n: NOISE_N }
}

fn with_sizes(hidden: &Hidden, sizes: &[f64]) -> Hidden {
    let mut hidden = *hidden;
    hidden.structure.iter_mut().for_each(|s| s.size = sizes[0]);
    hidden.effect.iter_mut().for_each(|(_, size, _)| *size = sizes[1]);
    hidden
}

/// Half of the sheets are known to the last bit where no effect and no friction is in them: what a known hole lacks is another law.
fn drawn(job: &Job) -> Object {
    let mut chance = Chance::new(job.seed, 61);
    let mut sheet = Sheet::plain(&mut chance);
    let is_known = chance.happens(0.5);
    let dry = chance.of_order(0.08, 0.25);
    if job.family.needs_friction() {
        sheet.dry_n = [dry; 2];
    }
    let is_plain = job.family.needs_friction() || job.needle_effect.is_some();
    let world = (is_known && !is_plain).then(|| known(&sheet));
    let plan = plan(&sheet, &mut chance);
    Object { sheet, plan, options: Options { world, ..Options::default() }, seed: job.seed }
}

/// A world with that sheet.
fn known(sheet: &Sheet) -> World {
    let mut world = presets::needle();
    if let Some(membrane) = &mut world.membrane {
        membrane.law = MembraneLaw {
            stiffness_n_m: sheet.stiffness_n_m,
            cubic_n_m3: 0.0,
            give: 0.0,
            puncture_n: sheet.puncture_n[0],
            friction_n: 0.0,
            drag_n_s_m: 0.0,
        };
    }
    world
}

/// A structure at work, step by step.
struct Meddler {
    structure: Option<Structure>,
    sheet: Sheet,
    sensor: ErringSensor,
    creep: Creep,
    before: (bool, bool),
    steps: usize,
    rows: Vec<Row>,
}

impl Meddler {
    fn meddle(&mut self, now: &Stroke) -> [f64; 2] {
        let more_n = self.structure.map_or(0.0, |s| self.more_n(&s, now));
        let felt_n = now.force_n + more_n;
        let state = (now.depth_m > 0.0, now.is_pierced);
        let is_struck = state != self.before && state.0;
        self.before = state;
        let error_n = self.structure.filter(|s| s.family.is_in_sensor()).map_or(0.0, |s| {
            let place_m = [now.depth_m, 0.0];
            let now = Moment { time_s: now.time_s, step_s: now.step_s, place_m, is_struck };
            self.sensor.read(&s, [felt_n, 0.0], &now)[0] - felt_n
        });
        if self.steps.is_multiple_of(EVERY) {
            self.rows.push(Row {
                time_s: now.time_s,
                depth_m: now.depth_m,
                is_pierced: now.is_pierced,
                force_n: now.force_n,
                wrong_n: more_n + error_n,
            });
        }
        self.steps += 1;
        [more_n, error_n]
    }

    /// Force that the structure adds to that of the sheet, N.
    fn more_n(&mut self, by: &Structure, now: &Stroke) -> f64 {
        let (x, speed) = (now.depth_m, now.speed_m_s);
        if by.family == Family::Relaxation {
            // The sheet remembers while the tool is outside, too.
            let elastic_n = if now.is_pierced { 0.0 } else { now.force_n };
            self.creep.follow([elastic_n, 0.0], by.shape[0], now.step_s);
            let fresh_n = elastic_n - self.creep.past(by.form)[0];
            return if x > 0.0 && !now.is_pierced { by.size * fresh_n * (x / RAMP_M).min(1.0) } else { 0.0 };
        }
        if x <= 0.0 {
            return 0.0;
        }
        let ramp = (x / RAMP_M).min(1.0);
        let site = 32 * now.place as u64;
        let rubs_n = self.sheet.dry_at_n(now.place, x) * speed / (speed * speed + 1e-8).sqrt();
        match by.family {
            Family::DepthField => by.size * ramp * by.over_place(site, x),
            Family::SpeedField => by.size * ramp * by.over_speed(speed),
            Family::StateField => by.size * ramp * by.over_state(0, [x, 0.0], [speed, 0.0]),
            Family::FrictionOverDepth if now.is_pierced => ((by.size * by.over_place(site, x)).exp() - 1.0) * rubs_n,
            Family::FrictionWander if now.is_pierced => ((by.size * by.over_time(0, now.time_s)).exp() - 1.0) * rubs_n,
            Family::SheetWander if !now.is_pierced => {
                let moved_m = by.size * by.over_time(0, now.time_s);
                ramp * (self.sheet.elastic_n((x - moved_m).max(0.0)) - self.sheet.elastic_n(x))
            }
            _ => 0.0,
        }
    }
}

/// A performance: the recording, and its rows without noise.
fn run(object: &Object, hidden: &Hidden, purpose: u64) -> (Recording, Vec<Row>) {
    let mut sheet = object.sheet;
    let drift_n_s = hidden.effect.map_or(0.0, |(kind, size, sign)| sign * kind.hide(size, &mut sheet));
    let mut meddler = Meddler {
        structure: hidden.structure,
        sheet,
        sensor: ErringSensor::new(0),
        creep: Creep::default(),
        before: (false, false),
        steps: 0,
        rows: Vec::new(),
    };
    let mut chance = Chance::new(object.seed, purpose);
    let recording = perform_with(&sheet, drift_n_s, &object.plan, &mut chance, &mut |now| meddler.meddle(now));
    let mut rows = meddler.rows;
    for row in &mut rows {
        row.force_n += drift_n_s * row.time_s;
    }
    (recording, rows)
}

/// Sizes over noise of the structure and of the effect.
fn ratios(object: &Object, hidden: &Hidden) -> Vec<f64> {
    let (_, with) = run(object, hidden, 63);
    let own: Vec<(Row, f64)> = with.iter().map(|row| (*row, row.wrong_n)).collect();
    let mut ratios = vec![ratio(&own)];
    if hidden.effect.is_some() {
        // Both with the structure: it may decide when the sheet is pierced.
        let (_, without) = run(object, &Hidden { effect: None, ..*hidden }, 63);
        let same = with.iter().zip(&without).filter(|(a, b)| a.is_pierced == b.is_pierced);
        let rows: Vec<(Row, f64)> = same.map(|(a, b)| (*a, a.force_n - b.force_n)).collect();
        ratios.push(ratio(&rows));
    }
    ratios
}

/// Size over noise in the channel that shows it best: outside beside a bias, on the sheet beside its stiffness, in its hole.
fn ratio(rows: &[(Row, f64)]) -> f64 {
    let of = |is_in: &dyn Fn(&Row) -> bool, known: &dyn Fn(&Row) -> f64| {
        let own: Vec<&(Row, f64)> = rows.iter().filter(|(row, _)| is_in(row)).collect();
        let column = own.iter().map(|(row, _)| known(row)).collect();
        rms_beside(own.iter().map(|(_, value)| *value).collect(), vec![column])
    };
    let outside = of(&|row| row.depth_m <= 0.0, &|_| 1.0);
    let on_sheet = of(&|row| row.depth_m > 0.0 && !row.is_pierced, &|row| row.depth_m);
    let in_hole = of(&|row| row.is_pierced, &|_| 0.0);
    outside.max(on_sheet).max(in_hole) / NOISE_N
}
