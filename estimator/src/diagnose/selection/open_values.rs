//! Searched values that the training rows leave open: the time of a sudden change within a held-out block.

use super::comparison::ChannelFit;
use super::normal_equations::ROUNDING;

/// Moves every such value to the one with the smallest residual of all rows. Any of them fits the training rows equally
/// well; with a wrong one, the block that holds the change would count against the cause.
pub fn close(study: &mut ChannelFit) {
    for k in 0..study.chosen.len() {
        let own = study.chosen[k].candidate;
        let Some((_, least)) = study.system.least(&study.picks()) else { return };
        let with = |candidate: usize| {
            let mut picks = study.picks();
            picks[k] = candidate;
            picks
        };
        let is_open = |c: &usize| {
            let (own, other) = (&study.candidates[own], &study.candidates[*c]);
            let same = own.id == other.id && own.linear == other.linear && !own.searched.is_empty();
            same && study.system.least(&with(*c)).is_some_and(|(_, rss)| rss <= least * (1.0 + ROUNDING))
        };
        let power = |c: &usize| study.residual(&with(*c)).iter().map(|r| r * r).sum::<f64>();
        let open = (0..study.candidates.len()).filter(is_open).map(|c| (power(&c), c));
        let best = open.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(own, |(_, best)| best);
        study.chosen[k].candidate = best;
    }
    study.solved = study.system.solve(&study.picks());
}

#[cfg(test)]
mod tests {
    use crate::diagnose::hypotheses::candidate::Candidate;
    use crate::diagnose::selection::channel::Channel;
    use crate::diagnose::selection::layout::{Layout, Use};
    use crate::diagnose::selection::normal_equations::uses;
    use crate::diagnose::selection::rules::Rules;
    use haptics::law::Kind;

    const ROWS: usize = 480;

    #[test]
    fn a_change_within_a_held_out_block_is_found_at_its_time() {
        let layout = Layout::of(vec![0; ROWS], &[true; ROWS], 0.02);
        let roles = uses(&layout);
        let locked: Vec<usize> = (0..ROWS).filter(|i| matches!(roles[*i], Use::Locked(7))).collect();
        let (first, last) = (locked[0], locked[locked.len() - 1]);
        let since = |start: usize| (0..ROWS).map(|i| f64::from(u8::from(i >= start))).collect::<Vec<f64>>();
        let change = |start: usize| {
            Candidate::one("mass-change", Kind::Plant, "step", "N", since(start)).at("t0", start as f64, "s")
        };
        let middle = usize::midpoint(first, last);
        assert!(locked.contains(&middle) && roles[middle - 1] == roles[middle + 1], "{locked:?}");
        let noise = |i: usize| 0.05 * (1.7 * (i * i) as f64).sin();
        let target = since(middle).iter().enumerate().map(|(i, step)| 0.3 * step + noise(i)).collect();
        let candidates = vec![change(middle - 3), change(middle + 4), change(middle), change(middle - 2)];
        let channel = Channel::new(target, vec![vec![1.0; ROWS]], candidates, layout, Rules::of_observations());
        let found = channel.fit().expect("a constant fits");
        assert_eq!(found.picks(), [2]);
    }
}
