//! Candidate terms of the net force on carried blocks: laws of the block and faults of the sensors.

use super::rows::{Place, Row, Rows};
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::sensor_fault::{BIAS, DRIFT, of_fingers};
use crate::diagnose::hypotheses::{
    force_bias, force_cross_axis, force_drift, force_gain, gravity_tilt, inertia, mass_change, viscous_friction,
};
use haptics::law::Kind;

/// Starts of a change of weight that are tried in every carry, in shares of its duration.
/// Choice: no case of the ablation reads it.
const WEIGHT_CHANGE_STARTS: Axis = Axis::even(1.0 / 7.0, 6.0 / 7.0, 6);
/// Names of the masses of the first few blocks.
const NAMES: [&str; 4] = ["m block-1", "m block-2", "m block-3", "m block-4"];

/// Laws that may act on carried blocks beside their weight and its inertia.
pub fn plant(rows: &Rows<'_>) -> Vec<Candidate> {
    let mut found = Vec::new();
    let blocks = rows.blocks();
    // Inertia without weight: of a counterweight, or of parts that move with the block.
    let moved = |k: Option<usize>| {
        rows.carried(
            |one, row, number, axis| {
                if k.is_none_or(|k| k == number) { one.acceleration[axis][row.i] } else { 0.0 }
            },
        )
    };
    found.push(Candidate::one(inertia::ID, Kind::Plant, "m", "kg", moved(None)).positive());
    if (2..=NAMES.len()).contains(&blocks) {
        let linear = NAMES[..blocks].iter().map(|n| (*n, "kg")).collect();
        let columns = (1..=blocks).map(|k| moved(Some(k))).collect();
        found.push(Candidate::several(inertia::ID, Kind::Plant, columns, linear).positive());
    }
    let drag = rows.carried(|one, row, _, axis| one.velocity[axis][row.i]);
    found.push(Candidate::one(viscous_friction::ID, Kind::Plant, "c", "N s/m", drag).positive());
    let tilted = rows.carried(|_, _, number, axis| if axis == 0 { rows.weight_n(number) } else { 0.0 });
    found.push(Candidate::one(gravity_tilt::ID, Kind::Plant, "angle", "rad", tilted));
    for k in 1..=blocks {
        leaks(rows, k, &mut found);
    }
    if blocks > 1 {
        found.push(Candidate::one(mass_change::ID, Kind::Plant, "rate", "N/s", leaking(rows)));
    }
    found
}

/// Weight of all that is carried, falling by one newton a second from when each is lifted: what runs out of one block
/// that is carried several times.
fn leaking(rows: &Rows<'_>) -> Vec<f64> {
    let lifted_s: Vec<f64> = (1..=rows.blocks())
        .map(|k| {
            let own = rows.all.iter().filter(|r| matches!(r.place, Place::Carried { number, .. } if number == k));
            own.map(|r| r.time_s).fold(f64::INFINITY, f64::min)
        })
        .collect();
    rows.carried(|_, row, number, axis| if axis == 1 { row.time_s - lifted_s[number - 1] } else { 0.0 })
}

/// Changes of the weight of one block: linear from the lift or from later on, or a step.
fn leaks(rows: &Rows<'_>, k: usize, found: &mut Vec<Candidate>) {
    let times: Vec<f64> =
        rows.all.iter().filter(|r| r.place == (Place::Carried { number: k, axis: 1 })).map(|r| r.time_s).collect();
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return };
    let lift = |of: &dyn Fn(f64) -> f64| {
        rows.carried(|_, row, number, axis| if number == k && axis == 1 { of(row.time_s) } else { 0.0 })
    };
    let rate = |from: f64| lift(&|t| (t - from).max(0.0));
    found.push(Candidate::one(mass_change::ID, Kind::Plant, "rate", "N/s", rate(*first)));
    for start in WEIGHT_CHANGE_STARTS.values().map(|share| first + (last - first) * share) {
        let later = Candidate::one(mass_change::ID, Kind::Plant, "rate", "N/s", rate(start));
        found.push(later.at("t0", start, "s"));
        let step = lift(&|t| f64::from(u8::from(t >= start)));
        found.push(Candidate::one(mass_change::ID, Kind::Plant, "step", "N", step).at("t0", start, "s"));
    }
}

/// Faults that the force sensors may have. `known`: weights that are known, N; `given`: the forces by them.
pub fn instrument(rows: &Rows<'_>, known: &[Option<f64>], given: &[f64]) -> Vec<Candidate> {
    let of = |finger: usize, axis: usize, size: &dyn Fn(&Row) -> f64| {
        rows.column(|r| Rows::share(r, finger, axis) * size(r))
    };
    let mut found = of_fingers(force_bias::ID, &BIAS, &|finger, axis| of(finger, axis, &|_| 1.0));
    found.extend(of_fingers(force_drift::ID, &DRIFT, &|finger, axis| of(finger, axis, &|r| r.time_s)));
    // Sensors may begin to drift when they are loaded: only what is free afterwards tells that from a block that
    // changes.
    let loaded_s = |r: &Row| {
        let carried = |o: &&Row| o.recording == r.recording && matches!(o.place, Place::Carried { .. });
        rows.all.iter().filter(carried).map(|o| o.time_s).fold(f64::INFINITY, f64::min)
    };
    let since: Vec<f64> =
        (0..rows.seen.len()).map(|k| rows.all.iter().find(|r| r.recording == k).map_or(0.0, loaded_s)).collect();
    for (finger, axis) in [(0, 1), (1, 1), (0, 0), (1, 0)] {
        let (name, unit) = DRIFT[finger][axis];
        let column = of(finger, axis, &|r| (r.time_s - since[r.recording]).max(0.0));
        found.push(Candidate::one(force_drift::ID, Kind::Instrument, name, unit, column));
    }
    // Effect on the carried rows of one finger's force along the other axis, of which only the sum is compared.
    let other = |row: &Row, finger: usize, to: usize| {
        let force = &rows.seen[row.recording].force[finger];
        Rows::share(row, finger, to) * force[1 - to][row.i]
    };
    for (finger, to, name) in [(0, 1, "kappa_yx1"), (1, 1, "kappa_yx2"), (0, 0, "kappa_xy1"), (1, 0, "kappa_xy2")] {
        let column = rows.column(|r| other(r, finger, to));
        found.push(Candidate::one(force_cross_axis::ID, Kind::Instrument, name, "1", column));
    }
    for (to, name) in [(1, "kappa_yx"), (0, "kappa_xy")] {
        let column = rows.column(|r| other(r, 0, to) + other(r, 1, to));
        found.push(Candidate::one(force_cross_axis::ID, Kind::Instrument, name, "1", column));
    }
    if known.iter().any(Option::is_some) {
        found.push(Candidate::one(force_gain::ID, Kind::Instrument, "g - 1", "1", given.to_vec()));
    }
    found
}
