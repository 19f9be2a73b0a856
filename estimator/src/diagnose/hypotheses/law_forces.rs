use crate::diagnose::data::regression_data::Track;
use crate::diagnose::data::row_means::column;
use haptics::law::{Effect, Memory};

/// Force that the laws need along every row; in a free motion each law is a mean over the row. Memory is cleared at every
/// segment.
pub fn needed(track: &Track, effects: &[Effect]) -> Vec<f64> {
    let mut sum = vec![0.0; track.rows.len()];
    for effect in effects {
        let own = match track.freely {
            _ if effect.remembers() => remembered(track, effect),
            Some(_) => column(track, effect),
            None => track.rows.iter().map(|row| effect.force(&row.motion)).collect(),
        };
        sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    }
    sum
}

/// The force of a law with a memory, row by row.
pub(crate) fn remembered(track: &Track, effect: &Effect) -> Vec<f64> {
    let rows = &track.rows;
    let mut memory = Memory::default();
    let mut force = |i: usize| {
        if track.follows(i) {
            let step_s = rows[i].motion.time_s - rows[i - 1].motion.time_s;
            effect.law().advance(&rows[i].motion, &effect.values, &mut memory, step_s);
        } else {
            memory = Memory::default();
        }
        effect.force_with(&rows[i].motion, &memory)
    };
    (0..rows.len()).map(&mut force).collect()
}
