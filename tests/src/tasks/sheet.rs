//! A sheet under a tool, in steps of 50 µs, and what the tool's instruments read.

use blind::Chance;
use haptics::recording::{Channel, Meta, Recording, Task};

/// Noise of a force, N.
///
/// Choice: that of the instruments at blocks.
pub const NOISE_N: f64 = 0.01;

/// What the tool meets.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    /// First stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Hardening, N/m³.
    pub cubic_n_m3: f64,
    /// Share of the depth that stays as a dent.
    pub dent: f64,
    /// Force at which each of two places is pierced, N.
    pub puncture_n: [f64; 2],
    /// Dry friction in the hole of each place, N.
    pub dry_n: [f64; 2],
    /// Drag of the shaft, N s/m.
    pub drag_n_s_m: f64,
    /// Dry friction by length in the hole, N/m.
    pub dry_n_m: f64,
    /// More of it: place, m, half width, m, and peak, N.
    pub catch: (f64, f64, f64),
    /// Lateness of the force, s.
    pub late_s: f64,
}

impl Sheet {
    /// A linear sheet that slides freely off the shaft.
    pub fn plain(chance: &mut Chance) -> Self {
        Self {
            stiffness_n_m: chance.between(120.0, 500.0),
            cubic_n_m3: 0.0,
            dent: 0.0,
            puncture_n: [chance.between(0.9, 2.0); 2],
            dry_n: [0.0; 2],
            drag_n_s_m: 0.0,
            dry_n_m: 0.0,
            catch: (0.0, 1.0, 0.0),
            late_s: 0.0,
        }
    }

    /// Elastic force at a depth, N.
    pub fn elastic_n(&self, x: f64) -> f64 {
        self.stiffness_n_m * x + self.cubic_n_m3 * x.powi(3)
    }

    /// Dry friction of a hole at a depth, N.
    pub fn dry_at_n(&self, place: usize, x: f64) -> f64 {
        let (at, within, most_n) = self.catch;
        let aside = ((x - at) / within).abs().min(1.0);
        self.dry_n[place] + self.dry_n_m * x + most_n * (1.0 - aside * aside).powi(2)
    }

    /// Force at a depth, N, after the past of the place.
    fn force_n(&self, past: &mut Past, place: usize, x: f64, speed: f64) -> f64 {
        if x <= 0.0 {
            return 0.0;
        }
        if past.is_pierced {
            // Rational in the speed: no kink at rest.
            return self.dry_at_n(place, x) * speed / (speed * speed + 1e-8).sqrt() + self.drag_n_s_m * speed;
        }
        let left = self.dent * past.deepest_m;
        let force_n = if x >= past.deepest_m {
            self.elastic_n(x)
        } else {
            self.elastic_n(past.deepest_m) * ((x - left) / (past.deepest_m - left)).max(0.0)
        };
        past.deepest_m = past.deepest_m.max(x);
        force_n
    }

    /// Depth at which it gives way the first time, m.
    pub fn deep_m(&self) -> f64 {
        let mut x = 0.0;
        while self.elastic_n(x) < self.puncture_n[0] {
            x += 1e-6;
        }
        x
    }
}

/// Wanted way of the tool.
pub struct Plan {
    /// Turning points of the way in: time, s, and depth, m.
    pub turns: Vec<(f64, f64)>,
    /// The same of the way across.
    pub cross: Vec<(f64, f64)>,
    /// A stand does it: at an even speed, without a tremor.
    pub is_even: bool,
}

/// A way through turning points (time, place): smooth, or at an even speed between them.
fn way(t: f64, turns: &[(f64, f64)], is_even: bool) -> f64 {
    let k = turns.partition_point(|(at, _)| *at <= t);
    let (Some(&(t0, from)), Some(&(t1, to))) = (k.checked_sub(1).and_then(|k| turns.get(k)), turns.get(k)) else {
        return if k == 0 { turns[0].1 } else { turns[turns.len() - 1].1 };
    };
    let s = (t - t0) / (t1 - t0);
    from + (to - from) * if is_even { s } else { s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s) }
}

/// One fine step of the tool at a sheet.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Time, s.
    pub time_s: f64,
    /// Length of the step, s.
    pub step_s: f64,
    /// Depth beyond the sheet at rest, m.
    pub depth_m: f64,
    /// Speed inward, m/s.
    pub speed_m_s: f64,
    /// Number of the place of the sheet.
    pub place: usize,
    /// The tool has gone through.
    pub is_pierced: bool,
    /// Force of the sheet, N.
    pub force_n: f64,
}

/// Past of a place of a sheet: how deep the tool was, m, and that it has gone through.
#[derive(Default)]
struct Past {
    deepest_m: f64,
    is_pierced: bool,
}

/// Changes a step: a force that acts beside that of the sheet, and an error of its reading, N.
pub type Meddle<'a> = dyn FnMut(&Stroke) -> [f64; 2] + 'a;

/// The sheet under the tool, and what its instruments read.
pub fn perform(sheet: &Sheet, drift_n_s: f64, plan: &Plan, chance: &mut Chance) -> Recording {
    perform_with(sheet, drift_n_s, plan, chance, &mut |_| [0.0; 2])
}

/// The same while something meddles.
pub fn perform_with(
    sheet: &Sheet,
    drift_n_s: f64,
    plan: &Plan,
    chance: &mut Chance,
    meddle: &mut Meddle<'_>,
) -> Recording {
    /// Length of a fine step, s.
    ///
    /// Choice: 20 within the shortest row.
    const FINE_S: f64 = 5e-5;
    let rate_hz = chance.pick(&[250.0, 500.0, 1000.0]);
    let every = (1.0 / (rate_hz * FINE_S)).round() as usize;
    let Plan { turns, cross, is_even } = plan;
    let tremor_m = if *is_even { 0.0 } else { 4e-5 };
    let end_s = turns[turns.len() - 1].0 + 0.5;
    let surface_m = chance.between(-0.02, 0.02);
    let bias = 0.03 * chance.normal();
    let phase = chance.between(0.0, 6.0);
    let (mut past, mut site, mut place) = (Past::default(), 0_usize, 0_usize);
    let (mut time, mut depth, mut side) = (Vec::new(), Vec::new(), Vec::new());
    let (mut felt, mut force): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut before = turns[0].1;
    for fine in 0..(end_s / FINE_S) as usize {
        let t = fine as f64 * FINE_S;
        let across = way(t, cross, false);
        let here = (across / 8e-3).round() as usize;
        if here != site {
            (site, place, past) = (here, here.min(1), Past::default());
        }
        let x = way(t, turns, *is_even) + tremor_m * (50.0 * t + phase).sin();
        let speed = (x - before) / FINE_S;
        before = x;
        let (is_pierced, force_n) = (past.is_pierced && x > 0.0, sheet.force_n(&mut past, place, x, speed));
        let now = Stroke { time_s: t, step_s: FINE_S, depth_m: x, speed_m_s: speed, place, is_pierced, force_n };
        let [more_n, error_n] = meddle(&now);
        past.is_pierced |= x > 0.0 && force_n + more_n >= sheet.puncture_n[place];
        if fine % every == 0 {
            time.push(t);
            depth.push(((surface_m + x + 1e-5 * chance.normal()) / 5e-6).round() * 5e-6);
            side.push(across + 1e-5 * chance.normal());
            felt.push(force_n + more_n + error_n);
            force.push(bias + drift_n_s * t + NOISE_N * chance.normal());
        }
    }
    let late = (sheet.late_s * rate_hz).round() as usize;
    for (i, read) in force.iter_mut().enumerate() {
        *read = ((*read + felt[i.saturating_sub(late)]) / 1e-3).round() * 1e-3;
    }
    recorded(time, [side, depth, force], chance)
}

/// A recording of a place across, a depth, and a force along it.
fn recorded(time: Vec<f64>, [side, depth, force]: [Vec<f64>; 3], chance: &mut Chance) -> Recording {
    let still: Vec<f64> = force.iter().map(|_| NOISE_N * chance.normal()).collect();
    let down = |values: Vec<f64>| values.into_iter().map(|v| -v).collect::<Vec<f64>>();
    let channels = [("x_m", side), ("y_m", down(depth)), ("fx_N", still), ("fy_N", down(force))];
    let unit = |name: &str| if name.starts_with('f') { "N" } else { "m" }.to_owned();
    Recording {
        name: "case".to_owned(),
        time_s: Some(time),
        channels: channels.map(|(name, values)| Channel { name: name.to_owned(), unit: unit(name), values }).to_vec(),
        meta: Meta { task: Some(Task::Needle), ..Meta::default() },
        ..Recording::default()
    }
}
