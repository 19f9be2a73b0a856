//! Stepwise regression over the candidates: forward selection with look-ahead, swaps, pruning.

use super::normal_equations::{ROUNDING, Solved, System};
use super::rules::Rules;
use crate::diagnose::data::limits::{MOST_ROUNDS, SIGNIFICANT};
use crate::diagnose::hypotheses::all::{form, relations};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::relations::Relation;
use std::cell::RefCell;
use std::collections::HashMap;

/// Number of causes above which a pair is tried. Beside a wrong first cause, several are needed to explain the effect
/// of two.
/// Choice: halved or doubled, none of 90 answers changes.
pub const MANY: usize = 2;
/// Most causes at once.
/// Choice: halved, 6 of 90 answers change (3 to right); doubled, 1 of 90 answers change.
const MOST_CAUSES: usize = 4;
/// Number of further causes if the model has no friction.
/// Derived: dry and viscous friction, which the model then lacks.
const FRICTIONS: usize = 2;
/// Loss of the folds, as a share of a cause's evidence, up to which they do not speak against it.
/// Choice: halved or doubled, none of 73 answers changes.
const SPARED: f64 = 0.05;

/// A chosen candidate with its evidence.
#[derive(Clone, Debug)]
pub struct SelectedTerm {
    pub candidate: usize,
    /// Evidence lost without it, 2 ln(likelihood) with penalty.
    pub score: f64,
    /// Likelihood ratio alone.
    pub lambda: f64,
    /// Rivals of the cause: candidate, and its deficit in evidence.
    pub rivals: Vec<(usize, f64)>,
}

/// Chooses among the candidates.
pub struct Stepwise<'a> {
    pub system: &'a System,
    pub candidates: &'a [Candidate],
    pub rules: Rules,
    relations: Vec<&'static [Relation]>,
    /// Cache of prices, by the causes in this order: swaps, prunings and restarts meet the same sets again.
    prices: RefCell<HashMap<Vec<usize>, f64>>,
}

/// Squared correlation of two causes' estimates from which they count as one.
/// Choice: halved, 3 of 13 answers change (3 to right); doubled, 0 of 13 answers change.
const AS_ONE: f64 = 0.99;
/// Mean square of two causes together, as a share of the weaker one's, below which they cancel.
/// Choice: halved, 1 of 17 answers change (1 to right); doubled, 0 of 17 answers change.
const CANCELLED_SHARE: f64 = 0.1;

impl<'a> Stepwise<'a> {
    pub fn new(system: &'a System, candidates: &'a [Candidate], rules: &Rules) -> Self {
        let relations = candidates.iter().map(|candidate| relations(candidate.id)).collect();
        Self { system, candidates, rules: *rules, relations, prices: RefCell::default() }
    }

    /// Evidence of single candidates, whatever else the rules would exclude beside them.
    pub fn of_each(system: &'a System, candidates: &'a [Candidate]) -> Self {
        Self::new(system, candidates, &Rules::of_channel(0.0))
    }
}

impl Stepwise<'_> {
    /// Most causes at once.
    pub(crate) fn most(&self) -> usize {
        if self.rules.has_dry_friction { MOST_CAUSES } else { MOST_CAUSES + FRICTIONS }
    }

    /// Price N ln(RSS) plus the penalty of the parameters; smaller is better. Infinite if a parameter has an impossible
    /// sign.
    pub(crate) fn price(&self, chosen: &[usize]) -> f64 {
        if let Some(price) = self.prices.borrow().get(chosen) {
            return *price;
        }
        let price = self.asked(chosen);
        self.prices.borrow_mut().insert(chosen.to_vec(), price);
        price
    }

    fn asked(&self, chosen: &[usize]) -> f64 {
        let is = |relation: Relation| chosen.iter().any(|c| self.has(*c, relation));
        if !self.rules.has_dry_friction && is(Relation::OfDryFriction) && !is(Relation::DryFriction) {
            return f64::INFINITY;
        }
        let Some((values, rss)) = self.system.least_sound(chosen) else { return f64::INFINITY };
        let mut doubt = 0.0;
        for (k, c) in chosen.iter().enumerate() {
            let (candidate, own) = (&self.candidates[*c], &values[self.system.own(chosen, k)]);
            if !candidate.admits(own) {
                return f64::INFINITY;
            }
            doubt += candidate.doubt(own);
        }
        self.paid(chosen, rss) + doubt
    }

    fn paid(&self, chosen: &[usize], rss: f64) -> f64 {
        let cost: f64 = chosen.iter().map(|c| self.candidates[*c].cost).sum();
        self.system.rows * rss.ln() + cost * self.system.rows.ln()
    }

    /// The same without sign constraints.
    fn plain_price(&self, chosen: &[usize]) -> Option<f64> {
        Some(self.paid(chosen, self.system.least_sound(chosen)?.1))
    }

    /// True if the cause of a candidate has a relation.
    pub(crate) fn has(&self, candidate: usize, relation: Relation) -> bool {
        self.relations[candidate].contains(&relation)
    }

    /// True if the causes of two candidates exclude each other.
    fn excludes(&self, a: usize, b: usize) -> bool {
        self.candidates[a].id == self.candidates[b].id
            || self.rules.one_loss && [a, b].iter().all(|c| self.has(*c, Relation::LosesMotion))
    }

    /// Candidates that may join the chosen ones: supported, and of another cause.
    pub(crate) fn open<'b>(&'b self, chosen: &'b [usize]) -> impl Iterator<Item = usize> + 'b {
        (0..self.candidates.len())
            .filter(|c| self.system.supported(*c))
            .filter(|c| chosen.iter().all(|o| !self.excludes(*o, *c)))
    }

    /// Price of each candidate that may join the chosen ones.
    pub fn priced(&self, chosen: &[usize]) -> Vec<(usize, f64)> {
        self.open(chosen).map(|c| (c, self.price(&[chosen, &[c]].concat()))).collect()
    }

    /// Evidence of a candidate beside the chosen ones, penalised for its parameters. `None` if it cannot join them, or
    /// only with an impossible sign.
    pub fn score_beside(&self, chosen: &[usize], c: usize) -> Option<f64> {
        let fits = chosen.iter().all(|o| !self.excludes(*o, c));
        let with = self.price(&[chosen, &[c]].concat());
        (fits && with.is_finite()).then_some(self.plain_price(chosen)? - with)
    }

    /// Causes after forward selection, swaps and pruning, strongest first. `before`: choice of an earlier round. The
    /// search then starts from it, and from nothing.
    pub fn run(&self, before: &[usize]) -> Vec<SelectedTerm> {
        // On a coarse grid, two causes may be needed to describe one, but they do not tell which.
        let is_fine = !before.is_empty();
        let mut chosen = self.settled(Vec::new(), is_fine);
        if is_fine {
            let going_on = self.settled(before.to_vec(), true);
            if self.price(&going_on) < self.price(&chosen) {
                chosen = going_on;
            }
        }
        // The search by single steps may end in a local optimum.
        if chosen.len() > MANY
            && let Some(pair) = self.pair()
        {
            let sparser = self.settled(pair, is_fine);
            if self.price(&sparser) < self.price(&chosen) {
                chosen = sparser;
            }
        }
        // Two causes that largely cancel are found by neither of them alone.
        if let Some(pair) = self.pair_beside(&chosen) {
            let more = self.settled([chosen.as_slice(), &pair].concat(), is_fine);
            if self.price(&more) < self.price(&chosen) {
                chosen = more;
            }
        }
        self.describe(&chosen)
    }

    /// Result of a search that starts with `chosen`; `merges`: true to replace two causes by one.
    fn settled(&self, mut chosen: Vec<usize>, merges: bool) -> Vec<usize> {
        while chosen.len() < self.most() {
            match cheapest(self.priced(&chosen)) {
                Some((best, price)) if price.is_finite() => chosen.push(best),
                _ => break,
            }
            self.swap(&mut chosen);
        }
        self.prune(&mut chosen);
        self.swap(&mut chosen);
        if merges {
            self.merge(&mut chosen);
        }
        self.prune(&mut chosen);
        chosen
    }

    /// Replaces two causes by one that explains as much: causes that cannot be separated from one are one.
    fn merge(&self, chosen: &mut Vec<usize>) {
        let pair = |chosen: &[usize]| {
            let all = (1..chosen.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
            let merged = all.filter_map(|(a, b)| {
                let rest = without(&without(chosen, b), a);
                let with = |c: usize| [rest.as_slice(), &[c]].concat();
                cheapest(self.priced(&rest)).map(|(c, price)| (with(c), price))
            });
            merged.min_by(|a, b| a.1.total_cmp(&b.1))
        };
        while let Some((better, _)) =
            pair(chosen).filter(|(_, price)| *price < self.price(chosen) + self.rules.ambiguous)
        {
            *chosen = better;
        }
    }

    pub(crate) fn swap(&self, chosen: &mut [usize]) {
        for _ in 0..MOST_ROUNDS {
            let mut changed = false;
            for k in 0..chosen.len() {
                let rest = without(chosen, k);
                let with = |c: usize| self.price(&[rest.as_slice(), &[c]].concat());
                let now = with(chosen[k]);
                if let Some((best, price)) = cheapest(self.priced(&rest))
                    && price < now - 1e-9
                {
                    chosen[k] = best;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// Removes the weakest cause until every remaining one is justified.
    fn prune(&self, chosen: &mut Vec<usize>) {
        while !chosen.is_empty() {
            let whole = self.price(chosen);
            let losses = (0..chosen.len()).map(|k| (k, self.price(&without(chosen, k)) - whole));
            let Some((weakest, loss)) = cheapest(losses) else { return };
            let is_doubtful =
                |k: &usize| !self.validates(chosen, *k) || self.remains(chosen, *k) || self.pulls_against(chosen, *k);
            if loss < self.rules.threshold {
                chosen.remove(weakest);
            } else if let Some(k) = (0..chosen.len()).find(is_doubtful) {
                chosen.remove(k);
            } else {
                return;
            }
            // A cause whose values were searched beside another one may be impossible without it, while its neighbour
            // on the grid is possible.
            if !self.price(chosen).is_finite() {
                self.swap(chosen);
            }
        }
    }

    /// True if the k-th cause may be misfit of a stronger one's curve.
    fn remains(&self, chosen: &[usize], k: usize) -> bool {
        // Without the sign constraints of the others.
        let loss = |k: usize| Some(self.plain_price(&without(chosen, k))? - self.plain_price(chosen)?);
        let form = |k: usize| form(self.candidates[chosen[k]].id);
        let own = form(k).over();
        (0..chosen.len())
            .filter(|o| *o != k && form(*o).of_curve().iter().any(|over| own.contains(over)))
            .any(|o| loss(k).zip(loss(o)).is_some_and(|(weak, strong)| weak < self.rules.remainder * strong))
    }

    /// True if the k-th cause and a better one are nearly collinear in this recording: large coefficients cancel, and
    /// only their difference matters. Causes that differ may cancel as well.
    fn pulls_against(&self, chosen: &[usize], k: usize) -> bool {
        let Some(solved) = self.system.solve(chosen) else { return false };
        let own = |k: usize| self.system.own(chosen, k);
        let covariance = |a: usize, b: usize| solved.inverse[(own(a).start, own(b).start)];
        let single = |o: usize| own(k).len() == 1 && own(o).len() == 1;
        let as_one = |o: usize| single(o) && covariance(k, o).powi(2) > AS_ONE * covariance(k, k) * covariance(o, o);
        let taken_back = |o: usize| {
            let [one, other] = [k, o].map(|k| own(k).collect::<Vec<usize>>());
            let weaker = self.power(&solved, &one).min(self.power(&solved, &other));
            self.power(&solved, &[one, other].concat()) < CANCELLED_SHARE * weaker
        };
        let left = |k: usize| self.plain_price(&without(chosen, k)).unwrap_or(f64::INFINITY);
        // A joint effect beyond doubt is real, even if it is small beside either of the two.
        let sure = |o: usize| {
            let rest: Vec<usize> = chosen.iter().copied().filter(|c| *c != chosen[k] && *c != chosen[o]).collect();
            self.plain_price(&rest)
                .is_some_and(|less| less - self.price(chosen) > self.rules.sure * self.rules.threshold)
        };
        (0..chosen.len()).filter(|o| *o != k).any(|o| (as_one(o) || taken_back(o) && !sure(o)) && left(k) < left(o))
    }

    /// Sum of squares, over the training rows, of the contribution of these regressors to a solution.
    fn power(&self, solved: &Solved, which: &[usize]) -> f64 {
        let part = |i: usize, j: usize| {
            solved.values[i] * solved.values[j] * self.system.train[(solved.columns[i], solved.columns[j])]
        };
        which.iter().map(|i| which.iter().map(|j| part(*i, *j)).sum::<f64>()).sum()
    }

    /// True if held-out folds improve with the k-th cause.
    fn validates(&self, chosen: &[usize], k: usize) -> bool {
        let (Some(with), Some(less)) =
            (self.system.cross_validate(chosen), self.system.cross_validate(&without(chosen, k)))
        else {
            return false;
        };
        let (before, after) = (less.iter().sum::<f64>(), with.iter().sum::<f64>());
        let better = less.iter().zip(&with).filter(|(l, w)| w < l).count();
        // If only rows that are never held out determine it (a bias beside gravity: the free rows), the folds do not
        // change.
        let gain = before - after;
        if self.is_spared(chosen, k, (before, after)) {
            return self.clear(chosen, k);
        }
        gain > 0.0 && (self.clear(chosen, k) || 5 * better >= 4 * with.len())
    }

    /// True if the folds lose little by the k-th cause compared with its evidence: they hardly contain its effect,
    /// while rows that are never held out do.
    fn is_spared(&self, chosen: &[usize], k: usize, (before, after): (f64, f64)) -> bool {
        let tested: f64 = self.system.folds.iter().map(|(_, rows)| rows).sum();
        let lost = tested * (after / before.max(1e-300)).max(1e-300).ln();
        let score = self.plain_price(&without(chosen, k)).map_or(0.0, |less| less - self.price(chosen));
        (-ROUNDING..SPARED * score).contains(&lost)
    }

    fn clear(&self, chosen: &[usize], k: usize) -> bool {
        let Some(solved) = self.system.solve(chosen) else { return false };
        let is_clear = |i: usize| solved.values[i].abs() > SIGNIFICANT * solved.std_error(i, self.system.rows);
        self.system.own(chosen, k).any(is_clear)
    }

    fn describe(&self, chosen: &[usize]) -> Vec<SelectedTerm> {
        let whole = self.price(chosen);
        let mut found: Vec<SelectedTerm> = (0..chosen.len())
            .map(|k| {
                let rest = without(chosen, k);
                // Without the cause, a remaining sign may be impossible. Its price is used all the same.
                let score = self.plain_price(&rest).unwrap_or(whole) - whole;
                let cost = self.candidates[chosen[k]].cost * self.system.rows.ln();
                SelectedTerm {
                    candidate: chosen[k],
                    score,
                    lambda: score + cost,
                    rivals: self.rivals(&rest, chosen[k], whole),
                }
            })
            .collect();
        let order = self.order(chosen);
        found.sort_by_key(|c| order.iter().position(|o| *o == c.candidate));
        found
    }

    /// The chosen causes in the order of forward selection: the strongest alone first.
    pub fn order(&self, chosen: &[usize]) -> Vec<usize> {
        let mut left = chosen.to_vec();
        let mut order: Vec<usize> = Vec::new();
        while !left.is_empty() {
            let price = |c: &usize| self.price(&[order.as_slice(), &[*c]].concat());
            let Some((next, _)) = cheapest((0..left.len()).map(|k| (k, price(&left[k])))) else { break };
            order.push(left.remove(next));
        }
        order
    }

    /// Evidence that the noise of its own regressor costs the last candidate of `chosen`. It is added back, because
    /// poor measurement does not speak against a cause.
    fn forgiven(&self, chosen: &[usize], c: usize) -> f64 {
        /// Largest share of the residual that this noise may account for.
        /// Choice: halved or doubled, none of 3 answers changes.
        const LARGEST_NOISE_SHARE: f64 = 0.9;
        let noise = self.candidates[c].noise;
        let Some(solved) = self.system.solve(chosen).filter(|_| noise > 0.0) else { return 0.0 };
        let own = self.system.own(chosen, chosen.len() - 1).start;
        let whitened = 1.0 + self.system.coefficients.iter().map(|a| a * a).sum::<f64>();
        let share = (solved.values[own] * noise).powi(2) * whitened * self.system.rows / solved.rss;
        -self.system.rows * (1.0 - share.min(LARGEST_NOISE_SHARE)).ln()
    }

    /// The best candidate of every other cause with nearly the same evidence in this one's place.
    fn rivals(&self, rest: &[usize], own: usize, whole: f64) -> Vec<(usize, f64)> {
        let mut best: Vec<(usize, f64)> = Vec::new();
        for c in self.open(rest).filter(|c| self.candidates[*c].id != self.candidates[own].id) {
            let others = [rest, &[c]].concat();
            let behind = (self.price(&others) - whole - self.forgiven(&others, c)).max(0.0);
            if !behind.is_finite() || behind > self.rules.ambiguous {
                continue;
            }
            match best.iter_mut().find(|(o, _)| self.candidates[*o].id == self.candidates[c].id) {
                Some(held) if held.1 > behind => *held = (c, behind),
                Some(_) => {}
                None => best.push((c, behind)),
            }
        }
        best.sort_by(|a, b| a.1.total_cmp(&b.1));
        best
    }
}

/// The cheapest candidate, the first of equal ones, and its price.
pub(crate) fn cheapest<T>(priced: impl IntoIterator<Item = (T, f64)>) -> Option<(T, f64)> {
    priced.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The chosen candidates without the k-th.
pub fn without(chosen: &[usize], k: usize) -> Vec<usize> {
    chosen.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, c)| *c).collect()
}
