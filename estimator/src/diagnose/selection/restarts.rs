//! Restarts of the search, because selection of one cause at a time may end in a local optimum.

use super::comparison::ChannelFit;
use super::rules::LIKELY_CAUSES;
use super::stepwise::{MANY, Stepwise};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::relations::Relation;

impl Stepwise<'_> {
    /// The best pair of causes: the strongest of each kind with its best partner, then each searched again beside the
    /// other.
    pub fn pair(&self) -> Option<Vec<usize>> {
        let mut alone: Vec<(f64, usize)> = self.open(&[]).map(|c| (self.price(&[c]), c)).collect();
        alone.retain(|(price, _)| price.is_finite());
        alone.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut firsts: Vec<usize> = Vec::new();
        for (_, c) in alone {
            if firsts.len() < LIKELY_CAUSES && firsts.iter().all(|f| self.candidates[*f].id != self.candidates[c].id) {
                firsts.push(c);
            }
        }
        let beside = |first: usize| {
            let pairs = self.open(&[first]).map(|c| (self.price(&[first, c]), c)).collect::<Vec<_>>();
            let (price, second) = pairs.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
            price.is_finite().then(|| (price, vec![first, second]))
        };
        let best = firsts.into_iter().filter_map(beside).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, mut pair)| {
            self.swap(&mut pair);
            pair
        })
    }

    /// The best two more causes beside the chosen ones, each kind as it explains most alone, if they explain something
    /// beyond doubt together.
    pub fn pair_beside(&self, chosen: &[usize]) -> Option<Vec<usize>> {
        if chosen.len() + 2 > self.most() {
            return None;
        }
        let with = |more: &[usize]| self.price(&[chosen, more].concat());
        let mut kinds: Vec<(f64, usize)> = Vec::new();
        for c in self.open(chosen) {
            let price = with(&[c]);
            match kinds.iter_mut().find(|(_, k)| self.candidates[*k].id == self.candidates[c].id) {
                Some(best) if price < best.0 => *best = (price, c),
                Some(_) => {}
                None => kinds.push((price, c)),
            }
        }
        let pairs = (1..kinds.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        let priced = pairs.map(|(a, b)| vec![kinds[a].1, kinds[b].1]).map(|pair| (with(&pair), pair));
        let (price, pair) = priced.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (price < with(&[]) - self.rules.sure * self.rules.threshold).then_some(pair)
    }

    /// Candidates that need a finer grid before they can be compared with the chosen ones. Of hysteresis and backlash
    /// this is the other one (they differ by less than half a step of the coarse grid). If many causes were chosen, the
    /// best pair is added.
    fn left_behind(&self, chosen: &[usize]) -> Vec<usize> {
        let is_loss = |c: &usize| self.has(*c, Relation::LosesMotion);
        let mut others = Vec::new();
        if let Some(k) = chosen.iter().position(&is_loss) {
            let rest: Vec<usize> = chosen.iter().copied().filter(|c| *c != chosen[k]).collect();
            let other = |c: &usize| is_loss(c) && self.candidates[*c].id != self.candidates[chosen[k]].id;
            let price = |c: usize| self.price(&[rest.as_slice(), &[c]].concat());
            let priced = self.open(&rest).filter(other).map(|c| (price(c), c)).collect::<Vec<_>>();
            let best = priced.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
            others.extend(best.filter(|(price, _)| price.is_finite()).map(|(_, c)| c));
        }
        if chosen.len() > MANY {
            others.extend(self.pair().unwrap_or_default());
        }
        others.retain(|c| !chosen.contains(c));
        others
    }
}

/// The candidates around which the next round searches: those that were chosen, and what else may turn out better once
/// it is searched for as closely.
pub fn to_refine(study: &ChannelFit) -> Vec<&Candidate> {
    let ChannelFit { system, candidates, rules, .. } = study;
    let picks = study.picks();
    let others = Stepwise::new(system, candidates, rules).left_behind(&picks);
    picks.iter().chain(&others).map(|c| &candidates[*c]).collect()
}
