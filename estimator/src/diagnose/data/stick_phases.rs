//! Stick phases: the displacement of an object that stands although it is pushed. It shows presliding and backlash much
//! more finely than the force does, whose direction is uncertain at a reversal.
//!
//! Rows of a track in which the force is below the friction and nothing moves become rows of their own. Their target is
//! the displacement from the middle of the stick phase, scaled to the noise of the force, so that both kinds of rows
//! count in one comparison. Pure Coulomb friction predicts zero there.

use super::limits::{AMBIGUOUS, FEWEST, SIGNIFICANT};
use super::regression_data::{Place, Row, Track};
use haptics::Vec2;
use haptics::law::{Hysteresis, Law, MAX_PARAMETERS, Memory, Motion};

/// Share of the friction up to which nothing slides, even if the friction is uncertain.
/// Choice: halved, 7 of 48 answers change; doubled, 9 of 48 answers change (1 to wrong, 1 to right).
const HOLDS: f64 = 0.7;
/// Largest displacement in a stick phase, as a share of the range (of the diameter, on a circle). A wider gap shows in
/// the force.
/// Choice: halved or doubled, none of 62 answers changes.
const LARGEST: f64 = 0.006;
/// Largest share of the friction up to which presliding is followed.
/// Choice: halved or doubled, none of 48 answers changes.
const MOST_BENT: f64 = 0.95;
/// Deviation of a stick phase's compliance from the usual one, as a share of it, from which it was a slow slide.
/// Choice: halved or doubled, none of 48 answers changes.
const UNLIKE: f64 = 0.7;
/// The same deviation in standard errors, added to the share.
/// Choice: halved or doubled, none of 48 answers changes.
const UNLIKE_SURE: f64 = 4.0;
/// Number of rows before and after over which position and load of a floating object are averaged.
/// Choice: halved or doubled, none of 48 answers changes.
const NEAR: usize = 2;
/// Ratio of noises up to which rows count as equally noisy.
/// Choice: halved or doubled, none of 48 answers changes.
const ALIKE: f64 = 2.0;
/// Steps in which a change of the load is followed.
/// Choice: halved or doubled, none of 46 answers changes.
const LOAD_STEPS: usize = 16;

/// Load on the friction in one row.
pub struct Load {
    /// Load on the friction as a share of it: −1 and 1 slide.
    pub share: f64,
    /// All of the force, as a share of the friction.
    pub whole: f64,
    /// The friction if it slid, N or N m.
    pub friction: f64,
}

/// Adds the rows of the stick phases. `loads`: one per row, `None` if the friction is unknown.
pub fn add(track: &mut Track, loads: &[Option<Load>]) {
    let noise = track.position_noise;
    if noise <= 0.0 || noise.is_nan() {
        return;
    }
    let largest = largest(track);
    let stands = |i: usize| {
        let below = |l: &Load| l.share.abs() < HOLDS && l.friction > SIGNIFICANT * track.force_noise;
        track.rows[i].place == Place::Along && loads[i].as_ref().is_some_and(below)
    };
    let stays = |range: std::ops::Range<usize>| {
        let places = track.rows[range].iter().map(|r| r.motion.position);
        places.clone().fold(f64::MIN, f64::max) - places.fold(f64::MAX, f64::min) < largest
    };
    let mut number = track.rows.iter().map(|r| r.segment + 1).max().unwrap_or(0);
    let mut made: Vec<Vec<Row>> = Vec::new();
    let mut first = 0;
    for i in 0..=track.rows.len() {
        if i < track.rows.len() && stands(i) && (first == i || track.follows(i)) {
            continue;
        }
        // A row at either end may already have moved.
        let still = first + 1..i.saturating_sub(1);
        if still.len() >= FEWEST && stays(still.clone()) {
            made.push(standstill(track, &loads[still.clone()], still, number));
            number += 1;
        }
        first = if i < track.rows.len() && stands(i) { i } else { i + 1 };
    }
    let made: Vec<Row> = alike(made, noise).concat();
    track.rows.extend(made);
}

/// Largest displacement of a standing object, m or rad.
fn largest(track: &Track) -> f64 {
    let range = track.quantile(1.0, |r| r.motion.position) - track.quantile(0.0, |r| r.motion.position);
    LARGEST * track.radius_m.map_or(range, |r| range.min(2.0 * r)) + 4.0 * track.position_noise
}

/// Stick phases with the usual compliance. A slow slide, whose force looks like that of a stick phase, may have any.
fn alike(made: Vec<Vec<Row>>, noise: f64) -> Vec<Vec<Row>> {
    let slope = |rows: &[Row]| {
        let (mut across, mut square) = (0.0, 0.0);
        let share = |r: &Row| if let Place::Stuck { share, .. } = r.place { share } else { 0.0 };
        let mean = rows.iter().map(share).sum::<f64>() / rows.len() as f64;
        for row in rows {
            let Place::Stuck { scale, .. } = row.place else { continue };
            across += (share(row) - mean) * row.target / scale;
            square += (share(row) - mean).powi(2);
        }
        (across / square.max(1e-12), noise / square.max(1e-12).sqrt())
    };
    let slopes: Vec<(f64, f64)> = made.iter().map(|rows| slope(rows)).collect();
    let usual = usual(&slopes);
    let keeps = |(slope, error): &(f64, f64)| (slope - usual).abs() < UNLIKE * usual.abs() + UNLIKE_SURE * error;
    let like = made.into_iter().zip(slopes).filter(|(_, s)| keeps(s));
    like.map(|(rows, _)| trusted(rows, usual, noise)).collect()
}

/// Reduces the weight of a stick phase with large displacement under small load: the noise of the load limits its
/// accuracy (effective variance, Orear 1982).
fn trusted(mut rows: Vec<Row>, slope: f64, noise_m: f64) -> Vec<Row> {
    let of_load = |row: &Row| if let Place::Stuck { noise, .. } = row.place { noise / SIGNIFICANT } else { 0.0 };
    let load = rows.iter().map(of_load).sum::<f64>() / rows.len().max(1) as f64;
    let share = noise_m / noise_m.hypot(slope * load);
    for row in &mut rows {
        row.target *= share;
        if let Place::Stuck { scale, .. } = &mut row.place {
            *scale *= share;
        }
    }
    rows
}

/// Weighted median of values with errors: each counts by its accuracy.
fn usual(slopes: &[(f64, f64)]) -> f64 {
    let mut sorted: Vec<(f64, f64)> = slopes.iter().map(|(s, e)| (*s, 1.0 / e.max(1e-300))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * sorted.iter().map(|s| s.1).sum::<f64>();
    let mut sum = 0.0;
    for (slope, weight) in sorted {
        sum += weight;
        if sum >= half {
            return slope;
        }
    }
    0.0
}

fn standstill(track: &Track, loads: &[Option<Load>], range: std::ops::Range<usize>, number: usize) -> Vec<Row> {
    let rows = &track.rows[range];
    let scale = track.force_noise / track.position_noise;
    let middle = rows.iter().map(|r| r.motion.position).sum::<f64>() / rows.len() as f64;
    let of = |k: usize| {
        let load = loads[k].as_ref()?;
        // The hand's load changes slowly, so it is averaged over neighbours.
        let near = k.saturating_sub(NEAR)..(k + NEAR + 1).min(loads.len());
        let count = near.len() as f64;
        let mean =
            |of: &dyn Fn(&Load) -> f64| near.clone().filter_map(|i| loads[i].as_ref()).map(of).sum::<f64>() / count;
        let noise = (ALIKE / count).sqrt() * track.force_noise / load.friction;
        let whole = mean(&|l| l.whole);
        let side = if whole.abs() > SIGNIFICANT * noise { whole.signum() } else { 0.0 };
        Some(Row {
            segment: number,
            place: Place::Stuck { share: mean(&|l| l.share), side, noise: SIGNIFICANT * noise, scale },
            along: Vec2::zeros(),
            force: Vec2::zeros(),
            force_rate: Vec2::zeros(),
            target: scale * (rows[k].motion.position - middle),
            open: 0.0,
            ..rows[k]
        })
    };
    (0..rows.len()).filter_map(of).collect()
}

/// Fills a regressor with the displacement `way` in the rows of each stick phase, less its mean.
fn fill(rows: &[Row], column: &mut [f64], way: &dyn Fn(&[Row]) -> Vec<f64>) {
    let mut first = 0;
    for stretch in rows.chunk_by(|a, b| a.segment == b.segment) {
        let here = first..first + stretch.len();
        first = here.end;
        let Place::Stuck { scale, .. } = stretch[0].place else { continue };
        let ways = way(stretch);
        let mean = ways.iter().sum::<f64>() / ways.len() as f64;
        column[here].iter_mut().zip(&ways).for_each(|(c, w)| *c = scale * (w - mean));
    }
}

/// Creep under load instead of sticking. Friction with a smooth sign, F tanh(v/v₀), as simulators use it, is balanced
/// at v₀ atanh(F/F₀). The result is the displacement in each stick phase at v₀ = 1.
fn creeps(rows: &[Row], column: &mut [f64]) {
    fill(rows, column, &|stretch| {
        let mut way = 0.0;
        let mut before: Option<(f64, f64)> = None;
        stretch
            .iter()
            .map(|row| {
                let Place::Stuck { share, .. } = row.place else { return way };
                let speed = share.clamp(-MOST_BENT, MOST_BENT).atanh();
                if let Some((time_s, was)) = before {
                    way += 0.5 * (speed + was) * (row.motion.time_s - time_s);
                }
                before = Some((row.motion.time_s, speed));
                way
            })
            .collect()
    });
}

/// Regressor of creep, if it explains the stick phases better than every presliding and backlash candidate alone. A
/// hand's load goes back and forth, which separates the displacement from the load.
pub fn creep(track: &Track, y: &[f64], losses: &[&[f64]]) -> Option<Vec<f64>> {
    let stuck: Vec<usize> = (0..y.len()).filter(|i| matches!(track.rows[*i].place, Place::Stuck { .. })).collect();
    let mut column = vec![0.0; y.len()];
    creeps(&track.rows, &mut column);
    let product = |a: &[f64], b: &[f64]| stuck.iter().map(|i| a[*i] * b[*i]).sum::<f64>();
    let told = |column: &[f64]| {
        let (across, square) = (product(column, y), product(column, column));
        if across > 0.0 && square > 0.0 { across * across / square } else { 0.0 }
    };
    let (all, by_creep) = (product(y, y), told(&column));
    let most = losses.iter().map(|loss| told(loss)).fold(0.0, f64::max);
    let left = (all - by_creep).max(1e-12 * all);
    // Worth a parameter, and better than any of the others.
    let worth = stuck.len() as f64 * (all / left).ln() > (stuck.len() as f64).ln() + AMBIGUOUS;
    (by_creep > most && worth).then_some(column)
}

/// Displacement of presliding friction under the loads. `law`: friction, stiffness and shape of the law of presliding.
pub fn bends(rows: &[Row], law: &[f64; 3], column: &mut [f64]) {
    let mut values = [0.0; MAX_PARAMETERS];
    values[..3].copy_from_slice(law);
    fill(rows, column, &|stretch| {
        let mut memory: Memory = Memory::default();
        let mut at = 0.0;
        stretch
            .iter()
            .enumerate()
            .map(|(k, row)| {
                let Place::Stuck { share, noise, .. } = row.place else { return at };
                let share = share.clamp(-MOST_BENT, MOST_BENT);
                if k == 0 {
                    memory[0] = share;
                } else if (share - memory[0]).abs() > noise {
                    // Noise alone causes no presliding: the tracked load stays behind by this much.
                    let aim = share - noise * (share - memory[0]).signum();
                    at += follow(&values, &mut memory, aim);
                }
                at
            })
            .collect()
    });
}

/// Displacement over which the law's friction reaches `aim`; the memory follows.
fn follow(values: &[f64; MAX_PARAMETERS], memory: &mut Memory, aim: f64) -> f64 {
    let side = (aim - memory[0]).signum();
    let mut gone = 0.0;
    for part in 0..LOAD_STEPS {
        let motion = Motion { velocity: side, direction: side, ..Motion::default() };
        let step = (aim - memory[0]) / (LOAD_STEPS - part) as f64;
        let stiffness = Hysteresis.stiffness(&motion, values, memory);
        if stiffness <= 0.0 {
            break;
        }
        let way = step / stiffness;
        Hysteresis.advance(&Motion { velocity: way, ..motion }, values, memory, 1.0);
        gone += way;
    }
    gone
}

/// Displacement within a gap of twice `half`, to the side of the load. A gap wider than the limit of a stick phase is
/// not crossed in one.
pub fn plays(track: &Track, half: f64, all: bool, column: &mut [f64]) {
    if 2.0 * half < largest(track) {
        lies(&track.rows, half, all, column);
    }
}

fn lies(rows: &[Row], half: f64, all: bool, column: &mut [f64]) {
    fill(rows, column, &|stretch| {
        let sides: Vec<f64> = stretch.iter().map(|row| side(row, all)).collect();
        let places: Vec<f64> = stretch.iter().map(place_m).collect();
        let pressed = || (0..stretch.len()).filter(|k| sides[*k] != 0.0);
        let count = pressed().count();
        let middle = if count > 0 {
            pressed().map(|k| places[k] - half * sides[k]).sum::<f64>() / count as f64
        } else {
            let floats = (0..stretch.len()).map(|k| around(&places, k));
            0.5 * (floats.clone().fold(f64::MAX, f64::min) + floats.fold(f64::MIN, f64::max))
        };
        // Without load the object floats within the gap, near its positions a moment before and after.
        let floats = |k: usize| (around(&places, k) - middle).clamp(-half, half);
        (0..stretch.len()).map(|k| middle + if sides[k] == 0.0 { floats(k) } else { half * sides[k] }).collect()
    });
}

/// Side to which the load presses an object with backlash; 0 if the load may be zero.
fn side(row: &Row, all: bool) -> f64 {
    let Place::Stuck { share, side, noise, .. } = row.place else { return 0.0 };
    match all {
        true => side,
        false if share.abs() > noise => share.signum(),
        false => 0.0,
    }
}

/// Displacement of a row from the middle of its stick phase.
fn place_m(row: &Row) -> f64 {
    if let Place::Stuck { scale, .. } = row.place { row.target / scale } else { 0.0 }
}

/// Mean of the neighbours of a position, without its own noise.
fn around(places: &[f64], k: usize) -> f64 {
    let near = k.saturating_sub(NEAR)..(k + NEAR + 1).min(places.len());
    let count = near.len() - 1;
    near.filter(|i| *i != k).map(|i| places[i]).sum::<f64>() / count.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(stretch: usize, share: f64, way_um: f64) -> Row {
        let place = Place::Stuck { share, side: share.signum(), noise: 0.02, scale: 1e3 };
        Row { segment: stretch, place, target: 1e-3 * way_um, ..Row::default() }
    }

    #[test]
    fn a_slow_slide_is_no_standstill() {
        // Three stick phases with a compliance of 20 µm per friction, and a slide of 300 µm while the load falls.
        let still = |k: usize| (0..6).map(|i| row(k, 0.1 * f64::from(i), 2.0 * f64::from(i) - 5.0)).collect::<Vec<_>>();
        let slides: Vec<Row> = (0..6).map(|i| row(9, -0.1 * f64::from(i), 60.0 * f64::from(i) - 150.0)).collect();
        let kept = alike(vec![still(1), slides, still(2), still(3)], 1e-6);
        assert_eq!(kept.iter().map(|rows| rows[0].segment).collect::<Vec<_>>(), [1, 2, 3]);
    }

    #[test]
    fn a_gap_jumps_where_the_load_changes_sides_and_a_bend_follows_it() {
        let shares = [0.5, 0.3, 0.1, -0.1, -0.3, -0.5];
        let rows: Vec<Row> = shares.iter().map(|s| row(1, *s, 0.0)).collect();
        let (mut gap, mut bend) = (vec![0.0; 6], vec![0.0; 6]);
        lies(&rows, 1e-4, false, &mut gap);
        assert!(
            (gap[0] - 0.1).abs() < 1e-12 && (gap[2] - gap[0]).abs() < 1e-12 && (gap[3] + 0.1).abs() < 1e-12,
            "{gap:?}"
        );
        bends(&rows, &[1.0, 1e4, 0.0], &mut bend);
        let steps: Vec<f64> = bend.windows(2).map(|w| w[0] - w[1]).collect();
        assert!(steps.iter().all(|s| *s > 0.005) && steps[2] < 2.0 * steps[3], "{bend:?}");
    }

    #[test]
    fn the_way_to_a_load_brings_the_friction_there() {
        let values = [1.0, 1e4, 0.0, 0.0, 0.0];
        let mut memory = [0.9, 0.0];
        let way = follow(&values, &mut memory, -0.5);
        // Dahl backwards from 0.9: (1 + z) falls by exp(−s/l), l = 0.1 mm.
        let expected = 1e-4 * (0.5_f64 / 1.9).ln();
        assert!((way - expected).abs() < 0.04 * expected.abs(), "{way} {expected}");
        assert!((memory[0] + 0.5).abs() < 0.03, "{}", memory[0]);
    }
}
