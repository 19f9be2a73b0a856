//! Competition of the chosen causes of a channel with structured errors that no law describes.
//!
//! A cause is certain only if the best model without it, in which structured errors may take its place, is clearly
//! worse. The model error is a rival here, where Kennedy & O'Hagan (2001) add it to every model.

use super::evidence::{Element, Fitted, Prior, Products};
use super::null_model::{Autoregression, NullModel, StructuredError};
use super::smooth::{Discrepancy, rms};
use super::standing::Competition;
use crate::diagnose::contract::Standing;
use crate::diagnose::data::limits::{HALF, MOST_ROUNDS, REFINEMENTS};
use crate::diagnose::selection::channel::leave_out_what_is_unsure;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::gram::gram;
use crate::diagnose::selection::held_out_gain::confirmed;
use crate::diagnose::selection::layout::Use;
use crate::diagnose::selection::noise_model::{Whitening, whitener};
use crate::diagnose::selection::normal_equations::{System, counted};
use crate::diagnose::selection::open_values;
use crate::diagnose::selection::stepwise::Stepwise;

/// Lets each chosen cause of a channel compete. `None` if the rows determine nothing.
pub fn compete(study: &ChannelFit, discrepancies: &[Discrepancy]) -> Option<Competition> {
    let (round, coefficients) = Round::last(study, study.picks(), discrepancies)?;
    let found = round.competition(study, discrepancies)?;
    Some(Competition { coefficients, ..found })
}

/// The best model of a channel that has no cause. `None` if the rows determine nothing.
pub fn without_causes(study: &ChannelFit, discrepancies: &[Discrepancy]) -> Option<NullModel> {
    let (Round { rivals, raw, best, .. }, coefficients) = Round::last(study, Vec::new(), discrepancies)?;
    let base = study.baseline.len();
    let mut predicted = vec![0.0; study.layout.rows()];
    for (column, value) in rivals.products.values(&best).into_iter().filter(|(column, _)| *column < base) {
        predicted.iter_mut().zip(raw[column]).for_each(|(p, c)| *p += value * c);
    }
    let beside_base = |values: Vec<(usize, f64)>| {
        let mut sum = vec![0.0; study.layout.rows()];
        for (column, value) in rivals.products.beside_base(values) {
            sum.iter_mut().zip(raw[column]).for_each(|(s, c)| *s += value * c);
        }
        sum
    };
    let error = |(d, _): &(usize, f64)| {
        let values: Vec<_> =
            rivals.products.values_of(&best, *d).into_iter().map(|(c, value)| (base + c, value)).collect();
        let waves = values.iter().map(|(column, _)| beside_base(vec![(*column, 1.0)])).collect();
        StructuredError { waves, rms: rms(&beside_base(values), &study.layout.weight) }
    };
    let errors = best.used.iter().map(error).collect();
    let noise = Autoregression { coefficients, innovation: best.noise.sqrt() };
    Some(NullModel { predicted, errors, noise, weight: study.layout.weight.clone(), target: study.target.clone() })
}

/// Rivals in a model: elements of causes come first, then those of discrepancies.
struct Rivals {
    products: Products,
    /// Penalty of each cause, ln.
    penalty: Vec<f64>,
    /// Penalty of a discrepancy, ln.
    discrepancy: f64,
    discrepancies: Vec<usize>,
}

impl Rivals {
    fn score(&self, model: &Fitted) -> f64 {
        let cost = |e: usize| self.penalty.get(e).copied().unwrap_or(self.discrepancy);
        model.ln_evidence - model.used.iter().map(|(e, _)| cost(*e)).sum::<f64>()
    }

    /// The model with the discrepancies that its rows ask for: added as long as one adds enough, then removed as long
    /// as one is superfluous.
    fn settled(&self, mut model: Fitted) -> Fitted {
        while let Some(more) = self.extended(&model).filter(|more| self.score(more) > self.score(&model)) {
            model = more;
        }
        while let Some(less) = self.reduced(&model).filter(|less| self.score(less) >= self.score(&model)) {
            model = less;
        }
        model
    }

    /// The model with the discrepancy that would add most, if that may be enough.
    fn extended(&self, model: &Fitted) -> Option<Fitted> {
        let is_open = |e: &usize| model.used.iter().all(|(u, _)| u != e);
        let open: Vec<usize> = self.discrepancies.iter().copied().filter(is_open).collect();
        if self.discrepancies.len() >= MOST_ROUNDS + open.len() {
            return None;
        }
        let screened = self.products.screen(model, &open)?.into_iter().max_by(|a, b| a.gain.total_cmp(&b.gain));
        let best = screened.filter(|s| s.gain > HALF * self.discrepancy)?;
        let used = model.used.iter().copied().chain([(best.element, best.variance)]).collect();
        self.products.fit(used, Some(model.noise))
    }

    /// The best model with one discrepancy less.
    fn reduced(&self, model: &Fitted) -> Option<Fitted> {
        let used = model.used.iter().filter(|(e, _)| self.discrepancies.contains(e));
        let less = used.filter_map(|(e, _)| self.products.without(model, *e));
        less.max_by(|a, b| self.score(a).total_cmp(&self.score(b)))
    }

    /// Standing of each cause. The one that discrepancies replace best leaves the model first, because it must not
    /// count for the others. `best`: the model at the end.
    fn standings(&self, best: &mut Fitted) -> Option<Vec<Standing>> {
        let causes = self.penalty.len();
        let mut standings = vec![Standing::default(); causes];
        loop {
            let present: Vec<usize> = best.used.iter().map(|(e, _)| *e).filter(|e| *e < causes).collect();
            let mut weakest: Option<(f64, Fitted)> = None;
            for k in present {
                let without = self.settled(self.products.without(best, k)?);
                let ln_bayes_factor = self.score(best) - self.score(&without);
                let [own, errors] =
                    [self.products.power_of(best, &[k]), self.products.power_of(best, &self.discrepancies)];
                standings[k].ln_bayes_factor = ln_bayes_factor;
                standings[k].share = own / (own + errors).max(f64::MIN_POSITIVE);
                if weakest.as_ref().is_none_or(|w| ln_bayes_factor < w.0) {
                    weakest = Some((ln_bayes_factor, without));
                }
            }
            match weakest {
                Some((ln_bayes_factor, without)) if ln_bayes_factor < 0.0 => *best = without,
                _ => return Some(standings),
            }
        }
    }
}

/// One competition with one whitening.
struct Round<'a> {
    /// Causes that take part.
    picks: Vec<usize>,
    rivals: Rivals,
    /// Columns of base model, causes, discrepancies, and the target.
    raw: Vec<&'a [f64]>,
    best: Fitted,
    standings: Vec<Standing>,
}

impl<'a> Round<'a> {
    /// The second of two rounds, with its whitening: the autoregression of the first took part of the slow structure for
    /// noise.
    fn last(study: &'a ChannelFit, picks: Vec<usize>, discrepancies: &'a [Discrepancy]) -> Option<(Self, Vec<f64>)> {
        let first = Self::of(study, picks, discrepancies, &study.system.coefficients)?;
        let used = vec![Use::Always; study.layout.rows()];
        let coefficients = whitener(&first.residual(study), &study.layout, &used);
        Some((Self::of(study, first.picks, discrepancies, &coefficients)?, coefficients))
    }

    fn of(
        study: &'a ChannelFit,
        picks: Vec<usize>,
        discrepancies: &'a [Discrepancy],
        coefficients: &[f64],
    ) -> Option<Self> {
        let white = Whitening::new(&study.layout.segment, &study.layout.weight, coefficients);
        let whole = white.leaves();
        let picked: Vec<usize> = (0..study.layout.rows()).filter(|i| whole[*i]).collect();
        let of_base = study.baseline.iter().map(Vec::as_slice);
        let of_causes = picks.iter().flat_map(|p| study.candidates[*p].regressors.iter().map(|c| c.as_slice()));
        let of_errors = discrepancies.iter().flat_map(|d| d.columns.iter().map(Vec::as_slice));
        let raw: Vec<&[f64]> = of_base.chain(of_causes).chain(of_errors).chain([study.target.as_slice()]).collect();
        let columns: Vec<Vec<f64>> = raw.iter().map(|c| white.of(c)).collect();
        let products = Products::new(
            gram(&columns, &picked),
            study.baseline.len(),
            counted(&picked, &study.layout),
            elements(study, &picks, discrepancies, &picked),
        )?;
        let tried = |p: usize| study.candidates.iter().filter(|c| c.id == study.candidates[p].id).count() as f64;
        let rivals = Rivals {
            products,
            penalty: picks.iter().map(|p| study.rules.unlikely + tried(*p).ln()).collect(),
            discrepancy: study.rules.discrepancy,
            discrepancies: (picks.len()..picks.len() + discrepancies.len()).collect(),
        };
        let named = (0..picks.len()).map(|k| (k, 1.0)).collect();
        let mut best = rivals.settled(rivals.products.fit(named, None)?);
        let standings = rivals.standings(&mut best)?;
        Some(Self { picks, rivals, raw, best, standings })
    }

    /// Weighted residual of the best model, discrepancies included.
    fn residual(&self, study: &ChannelFit) -> Vec<f64> {
        let mut left = self.raw[self.raw.len() - 1].to_vec();
        for (column, value) in self.rivals.products.values(&self.best) {
            left.iter_mut().zip(self.raw[column]).for_each(|(l, c)| *l -= value * c);
        }
        left.iter().zip(&study.layout.weight).map(|(l, w)| l * w).collect()
    }

    fn competition(self, study: &ChannelFit, discrepancies: &[Discrepancy]) -> Option<Competition> {
        let Self { picks, rivals, raw, best, mut standings } = self;
        for (k, standing) in standings.iter_mut().enumerate() {
            standing.held_out_evidence = confirmed(study, k);
        }
        let rows = study.layout.rows();
        // The sum of the discrepancies, and its part that the model's regressors cannot fit.
        let (mut sum, mut beside) = (vec![0.0; rows], vec![0.0; rows]);
        let added = |to: &mut [f64], values: &[(usize, f64)]| {
            for (column, v) in values {
                to.iter_mut().zip(raw[*column]).for_each(|(t, c)| *t += v * c);
            }
        };
        let mut over: Vec<(&'static str, f64)> = Vec::new();
        for e in rivals.discrepancies.iter().filter(|e| best.used.iter().any(|(u, _)| u == *e)) {
            let values = rivals.products.values_of(&best, *e);
            let values: Vec<_> = values.into_iter().map(|(column, v)| (study.baseline.len() + column, v)).collect();
            added(&mut sum, &values);
            let mut own = vec![0.0; rows];
            added(&mut own, &rivals.products.beside_base(values));
            over.push((discrepancies[e - picks.len()].over, rms(&own, &study.layout.weight)));
            beside.iter_mut().zip(&own).for_each(|(b, o)| *b += o);
        }
        over.sort_by(|a, b| b.1.total_cmp(&a.1));
        let causes: Vec<usize> = (0..picks.len()).collect();
        let [named, errors] = [&causes, &rivals.discrepancies].map(|of| rivals.products.power_of(&best, of));
        let named_alone = best.used.iter().filter(|(e, _)| *e < picks.len()).copied().collect();
        let evidence = rivals.score(&best) - rivals.score(&rivals.products.fit(named_alone, Some(best.noise))?);
        let share = errors / (named + errors).max(f64::MIN_POSITIVE);
        let used = best.used.iter().filter(|(e, _)| *e >= picks.len()).map(|(e, v)| (e - picks.len(), v / best.noise));
        Some(Competition {
            causes: standings,
            rms: rms(&beside, &study.layout.weight),
            error: sum,
            over,
            evidence,
            whole: [rivals.score(&best), rivals.products.freedom()],
            share,
            used: used.collect(),
            coefficients: Vec::new(),
        })
    }
}

/// Causes and discrepancies with their priors. A cause may explain all that the base model leaves.
fn elements(study: &ChannelFit, picks: &[usize], discrepancies: &[Discrepancy], picked: &[usize]) -> Vec<Element> {
    let plain = study.residual(&[]);
    let mean_square = |of: &[f64]| picked.iter().map(|i| (study.layout.weight[*i] * of[*i]).powi(2)).sum::<f64>();
    let left = mean_square(&plain);
    let mut at = 0;
    let mut place = |columns: usize| {
        at += columns;
        at - columns..at
    };
    let of_cause = |pick: &usize| {
        let own = &study.candidates[*pick].regressors;
        let variance = |c: &[f64]| left / (own.len() as f64 * mean_square(c)).max(f64::MIN_POSITIVE);
        (own.len(), Prior::Fixed(own.iter().map(|c| variance(c)).collect()))
    };
    let causes = picks.iter().map(of_cause);
    let errors = discrepancies.iter().map(|d| (d.columns.len(), Prior::Estimated));
    causes.chain(errors).map(|(columns, prior)| Element { columns: place(columns), prior }).collect()
}

/// Lets the causes of a comparison compete, and chooses them anew beside the discrepancies found, until the choice stays,
/// for a few rounds. Values and figures stay those of the model with its causes alone, which a world can have.
pub fn settle(mut study: ChannelFit) -> ChannelFit {
    let errors = std::mem::take(&mut study.errors);
    let mut found = compete(&study, &errors);
    let mut plain = None;
    for _ in 0..REFINEMENTS {
        let before = study.picks();
        let Some(system) = found.as_ref().and_then(|found| beside(&study, found, &errors)) else { break };
        study.chosen = Stepwise::new(&system, &study.candidates, &study.rules).run(&before);
        let before_this = std::mem::replace(&mut study.system, system);
        let alone = plain.get_or_insert(before_this);
        // The order is that in which a model with causes alone needs them.
        let order = Stepwise::new(alone, &study.candidates, &study.rules).order(&study.picks());
        study.chosen.sort_by_key(|c| order.iter().position(|o| *o == c.candidate));
        open_values::close(&mut study);
        study.competition = found.take();
        leave_out_what_is_unsure(&mut study);
        found = compete(&study, &errors);
        if study.picks() == before {
            break;
        }
    }
    if let Some(plain) = plain {
        study.system = plain;
        study.solved = study.system.solve(&study.picks());
    }
    study.competition = found.map(|found| Competition { error: Vec::new(), ..found });
    study.errors = errors;
    study
}

/// Normal equations whose noise includes the discrepancies of a competition. `None` without any.
fn beside(study: &ChannelFit, found: &Competition, discrepancies: &[Discrepancy]) -> Option<System> {
    if found.used.is_empty() {
        return None;
    }
    let columns = found.used.iter().flat_map(|(d, _)| &discrepancies[*d].columns);
    let precision: Vec<f64> =
        found.used.iter().flat_map(|(d, v)| vec![v.recip(); discrepancies[*d].columns.len()]).collect();
    let ChannelFit { baseline, candidates, target, layout, .. } = study;
    let base: Vec<Vec<f64>> = baseline.iter().chain(columns).cloned().collect();
    let mut system = System::new(&base, candidates, target, layout, found.coefficients.clone());
    if !system.marginalize(baseline.len(), &precision) {
        return None;
    }
    let error = Whitening::new(&layout.segment, &layout.weight, &found.coefficients).of(&found.error);
    let last = system.target();
    system.whitened[last].iter_mut().zip(&error).for_each(|(target, error)| *target -= error);
    system.resisting.clone_from(&study.system.resisting);
    system.pieces.clone_from(&study.system.pieces);
    Some(system)
}
