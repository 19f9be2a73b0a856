//! Generic terms: regressors without a physical law, which detect the variable of an unexplained residual.

use super::candidate::Candidate;
use crate::diagnose::data::regression_data::{Place, Row, Track};
use haptics::law::Coordinate;

/// Number of generic waves round a turn, over the range, or in time.
/// Choice: halved, 4 of 48 answers change; doubled, 2 of 48 answers change.
const GENERIC_WAVES: u32 = 6;
/// The same where the rows are few.
/// Choice: halved or doubled, none of 14 answers changes.
pub(crate) const FEW_WAVES: u32 = 4;

/// Factor of a wave, with its name.
type Factor<'a> = (&'a str, Box<dyn Fn(&Row) -> f64 + 'a>);

/// All of them.
pub fn generic(track: &Track) -> Vec<Candidate> {
    generic_of(track, GENERIC_WAVES, GENERIC_WAVES)
}

/// Half waves over the duration of these times, s: generic terms of a channel in this unit.
pub fn slow_waves(time_s: &[f64], count: u32, unit: &'static str) -> impl Iterator<Item = Candidate> {
    let span_s = time_s.iter().copied().fold(0.0, f64::max).max(1e-9);
    (1..=count).map(move |k| {
        let wave = time_s.iter().map(|t| (std::f64::consts::PI * f64::from(k) * t / span_s).cos()).collect();
        Candidate::term(format!("cos({k} pi t/T)"), unit, vec![wave])
    })
}

/// The same with this number of waves over the range, and in time.
pub fn generic_of(track: &Track, waves: u32, slow: u32) -> Vec<Candidate> {
    let mut all = Vec::new();
    let force = if track.coordinate == Coordinate::Angular { "N m" } else { "N" };
    let fast = track.quantile(0.9, |r| r.motion.velocity.abs()).max(1e-12);
    let low = track.quantile(0.0, |r| r.angle_rad);
    let range = (track.quantile(1.0, |r| r.angle_rad) - low).max(1e-12);
    let phase = |row: &Row| {
        if track.radius_m.is_some() { row.angle_rad } else { std::f64::consts::TAU * (row.angle_rad - low) / range }
    };
    let mut factors: Vec<Factor<'_>> = vec![
        ("1", Box::new(|_| 1.0)),
        ("sgn(v)", Box::new(|r: &Row| r.motion.direction)),
        ("v", Box::new(move |r: &Row| r.motion.velocity / fast)),
    ];
    if track.planar {
        factors.push(("Fn", Box::new(|r: &Row| r.motion.normal_force_n)));
    }
    // Along a line, waves are counted over the range.
    let turns = if track.radius_m.is_some() { String::new() } else { format!("2 pi/{range:.3} ") };
    let wave = |n: u32, of: fn(f64) -> f64| column(track, &|r| of(f64::from(n) * phase(r)));
    let waves: Vec<[Vec<f64>; 2]> = (1..=waves).map(|n| [wave(n, f64::cos), wave(n, f64::sin)]).collect();
    for (name, factor) in &factors {
        let factor = column(track, factor);
        for (n, waves) in (1..).zip(&waves) {
            let times = |wave: &Vec<f64>| wave.iter().zip(&factor).map(|(w, f)| w * f).collect();
            let columns = waves.iter().map(times).collect();
            let unit = if *name == "Fn" { "1" } else { force };
            all.push(Candidate::term(format!("{name} cos({n} {turns}q + phi)"), unit, columns));
        }
    }
    for share in [0.2, 0.5, 0.8] {
        let bend = share * fast;
        let hinge = |r: &Row| (r.motion.velocity.abs() - bend).max(0.0) / fast * r.motion.direction;
        all.push(Candidate::term(format!("max(abs(v) - {bend:.3}, 0) sgn(v)"), force, vec![column(track, &hinge)]));
    }
    for k in 1..=slow {
        let wave = |r: &Row| (std::f64::consts::PI * f64::from(k) * r.motion.time_s / track.span_s.max(1e-9)).cos();
        all.push(Candidate::term(format!("cos({k} pi t/T)"), force, vec![column(track, &wave)]));
    }
    for (name, unit, values) in track.extras() {
        let rows = track.rows.iter().enumerate();
        let column = rows.map(|(i, r)| if r.place == Place::Along { values[i] } else { 0.0 }).collect();
        all.push(Candidate::term(name.clone(), force, vec![column]).with((name, unit)));
    }
    if track.planar {
        let square = |r: &Row| r.motion.normal_force_n.powi(2);
        let turned = column(track, &|r| square(r) * r.motion.direction);
        all.push(Candidate::term("Fn^2 sgn(v)".to_owned(), "1/N", vec![turned]));
        all.push(Candidate::term("Fn^2".to_owned(), "1/N", vec![column(track, &square)]));
    }
    all
}

fn column(track: &Track, of: &dyn Fn(&Row) -> f64) -> Vec<f64> {
    // The noise of a place in the middle of a row of a free motion is that of its acceleration: a mean is taken, as of
    // the laws.
    let mean = |row: &Row| track.mean(row, &|m| of(&Row { motion: *m, angle_rad: m.position, ..*row }));
    let value = |row: &Row| if track.freely.is_some() { mean(row) } else { of(row) };
    track.rows.iter().map(|r| if r.place == Place::Along { value(r) } else { 0.0 }).collect()
}
