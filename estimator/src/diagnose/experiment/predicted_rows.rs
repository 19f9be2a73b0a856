//! Predicted rows of a motion that has not been made yet, with the forces of the base model.

use super::motions::Excitation;
use super::strokes::Course;
use crate::diagnose::contract::Experiment;
use crate::diagnose::data::direction::blur;
use crate::diagnose::data::regression_data::{Bearing, Model, Place, Row, Track};
use crate::diagnose::data::row_means::column;
use haptics::Vec2;
use haptics::law::Motion;

/// Predicted rows of an experiment on the object of `track`. `values`: estimates of the model's laws.
pub fn imagine(track: &Track, model: &Model, values: &[f64], excitation: &Excitation, asked: &Experiment) -> Track {
    let scale = if track.planar { track.radius_m.unwrap_or(1.0) } else { 1.0 };
    let step = track.period_s;
    let course = Course::of(excitation, asked.fast / asked.half_range.max(1e-12), asked.seconds);
    let place = |t: f64| scale * (asked.middle + asked.half_range * course.at(t.max(0.0)).0);
    let count = (asked.seconds / step) as usize;
    let rows = (0..count).map(|i| {
        let t = i as f64 * step;
        let position = place(t);
        let angle_rad = track.radius_m.map_or(position, |r| position / r);
        let along = if track.planar { Vec2::new(-angle_rad.sin(), angle_rad.cos()) } else { Vec2::x() };
        let motion = Motion {
            time_s: t + asked.free_s,
            position,
            velocity: (place(t + step) - place(t - step)) / (2.0 * step),
            acceleration: (place(t + step) - 2.0 * position + place(t - step)) / (step * step),
            direction: 0.0,
            normal_force_n: if track.planar { asked.across_n * course.at(t).1 } else { 0.0 },
            up_along: if track.planar { along.y } else { 0.0 },
        };
        Row { motion, angle_rad, along, ..Row::default() }
    });
    let mut imagined = Track {
        rows: rows.collect(),
        fine: Vec::new(),
        span_s: asked.seconds + 2.0 * asked.free_s,
        hung: Vec::new(),
        bearing: Bearing::default(),
        slope: None,
        extra: Vec::new(),
        freely: None,
        ..track.clone()
    };
    blur(&mut imagined);
    let base: Vec<Vec<f64>> = model.iter().map(|e| column(&imagined, e)).collect();
    for i in 0..imagined.rows.len() {
        let y: f64 = base.iter().zip(values).map(|(c, v)| c[i] * v).sum();
        let row = &mut imagined.rows[i];
        let outward = Vec2::new(row.along.y, -row.along.x);
        row.y = y;
        row.force = if track.planar { row.along * y + outward * row.motion.normal_force_n } else { Vec2::new(y, 0.0) };
    }
    for i in 1..imagined.rows.len().saturating_sub(1) {
        let rate = (imagined.rows[i + 1].force - imagined.rows[i - 1].force) / (2.0 * step);
        imagined.rows[i].force_rate = rate;
    }
    if track.planar {
        add_free(&mut imagined, asked.free_s);
    }
    imagined
}

fn add_free(track: &mut Track, free_s: f64) {
    let count = (free_s / track.period_s) as usize;
    for (k, (axis, place)) in [(Vec2::x(), Place::FreeX), (Vec2::y(), Place::FreeY)].into_iter().enumerate() {
        for end in 0..2 {
            let start_s = if end == 0 { 0.0 } else { track.span_s - free_s };
            let period_s = track.period_s;
            track.rows.extend((0..count).map(|i| {
                let motion = Motion { time_s: start_s + i as f64 * period_s, ..Motion::default() };
                Row { stretch: 1 + 2 * k + end, place, motion, along: axis, ..Row::default() }
            }));
        }
    }
}
