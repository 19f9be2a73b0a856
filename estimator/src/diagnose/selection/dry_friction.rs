//! Estimated friction of a model: its size in every row, and its sign.

use super::comparison::ChannelFit;
use super::normal_equations::Solved;
use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::hypotheses::coulomb_friction;
use haptics::law::{Effect, Motion, Role};

/// Sum of the model's laws in all rows at these values: all laws, or only those that oppose motion.
pub fn total(rows: usize, model: &Model, base: &[Vec<f64>], values: &[f64], resists: bool) -> Vec<f64> {
    let mut sum = vec![0.0; rows];
    for ((effect, column), value) in model.iter().zip(base).zip(values) {
        if !resists || is_resisting(effect) {
            sum.iter_mut().zip(column).for_each(|(s, c)| *s += value * c);
        }
    }
    sum
}

/// True if there is dry friction and it opposes motion.
pub fn friction_is_sound(model: &Model, values: &[f64]) -> bool {
    let mut dry = model.iter().zip(values).filter(|(e, _)| e.law().is_dry()).map(|(_, v)| *v).peekable();
    dry.peek().is_some() && dry.all(|v| v > 0.0)
}

/// True if a law dissipates work in either direction.
pub fn is_resisting(effect: &Effect) -> bool {
    matches!(effect.role(), Role::Dry | Role::Presliding | Role::Viscous)
}

/// Ratio of the dry friction `used` for shares, by row, to the estimated one along the motion, and its relative error.
pub fn shares_of(track: &Track, model: &Model, used: &[f64], study: &ChannelFit) -> [f64; 2] {
    let Some(solved) = &study.solved else { return [1.0, 0.0] };
    let along = |level: &dyn Fn(usize) -> f64| track.along().map(level).sum::<f64>();
    let found = dry_levels(track, model, study, solved);
    let (used, now) = (along(&|i| used[i]), along(&|i| found[i]));
    let dry = model.iter().enumerate().filter(|(_, effect)| effect.law().is_dry());
    let error = |(k, effect): (usize, &Effect)| {
        solved.std_error(k, study.system.rows) * along(&|i| level(effect, track, i).abs())
    };
    if used > 0.0 && now > 0.0 { [used / now, dry.map(error).sum::<f64>() / now] } else { [1.0, 0.0] }
}

/// Size of the dry friction at each row if it slid: that of the model's laws, and Coulomb friction that was found beside
/// them.
fn dry_levels(track: &Track, model: &Model, study: &ChannelFit, solved: &Solved) -> Vec<f64> {
    let found = study.found().into_iter().filter(|(c, _)| c.id == coulomb_friction::ID);
    let beside: f64 = found.map(|(_, values)| values[0]).sum();
    (0..study.target.len()).map(|i| dry_level(track, model, &solved.values, i) + beside).collect()
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
