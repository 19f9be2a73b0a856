//! What a model's friction comes out at: its size in every row, and whether it resists.

use super::force::Model;
use super::system::Solved;
use super::track::Track;
use haptics::law::{Effect, Motion, Role};

/// What the model's laws add up to in all rows at these values, all of them or those that resist motion.
pub fn total(rows: usize, model: &Model, base: &[Vec<f64>], values: &[f64], resists: bool) -> Vec<f64> {
    let mut sum = vec![0.0; rows];
    for ((effect, column), value) in model.iter().zip(base).zip(values) {
        if !resists || is_resisting(effect) {
            sum.iter_mut().zip(column).for_each(|(s, c)| *s += value * c);
        }
    }
    sum
}

/// Whether there is dry friction and it resists.
pub fn friction_is_sound(model: &Model, values: &[f64]) -> bool {
    let mut dry = model.iter().zip(values).filter(|(e, _)| e.law().is_dry()).map(|(_, v)| *v).peekable();
    dry.peek().is_some() && dry.all(|v| v > 0.0)
}

/// Whether a law takes work whichever way it goes.
pub fn is_resisting(effect: &Effect) -> bool {
    matches!(effect.role(), Role::Dry | Role::Presliding | Role::Viscous)
}

/// `used`: the dry friction of each row that shares were asked of; its ratio to what the model came out at beside them, along the motion, and the
/// relative error of that.
pub fn shares_of(track: &Track, model: &Model, used: &[f64], solved: &Solved, rows: f64) -> [f64; 2] {
    let of = |level: &dyn Fn(usize) -> f64| track.along().map(level).sum::<f64>();
    let (used, now) = (of(&|i| used[i]), of(&|i| dry_level(track, model, &solved.values, i)));
    let variance = solved.variance(rows);
    let dry = model.iter().enumerate().filter(|(_, effect)| effect.law().is_dry());
    let error = |(k, effect): (usize, &Effect)| {
        (variance * solved.inverse[(k, k)]).sqrt() * of(&|i| level(effect, track, i).abs())
    };
    if used > 0.0 && now > 0.0 { [used / now, dry.map(error).sum::<f64>() / now] } else { [1.0, 0.0] }
}

/// Size of the model's dry friction at a row if it slid.
pub fn dry_level(track: &Track, model: &Model, values: &[f64], i: usize) -> f64 {
    let dry = model.iter().zip(values).filter(|(e, _)| e.law().is_dry());
    dry.map(|(e, v)| v * level(e, track, i)).sum::<f64>().abs()
}

/// Size of a dry law's force at a row if it slid.
fn level(effect: &Effect, track: &Track, i: usize) -> f64 {
    let motion = Motion { direction: 1.0, ..track.rows[i].motion };
    effect.force(&motion)
}
