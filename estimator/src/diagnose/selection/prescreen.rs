//! Prescreen before the noise is known: the strongest causes, from few of the products of all columns.

use super::gram::{PANEL, STRIP, Weighed};
use super::layout::Layout;
use super::layout::Use;
use super::normal_equations::{FOLDS, System, columns_of, counted, energy, places, uses};
use super::rules::LIKELY_CAUSES;
use super::stepwise::{Stepwise, cheapest};
use crate::diagnose::hypotheses::candidate::Candidate;
use nalgebra::DMatrix;

/// A system without whitening, whose products are computed when they are needed: those of the model with all columns,
/// then those of each chosen cause. Products not yet computed are NaN.
pub struct Rough<'a> {
    system: System,
    candidates: &'a [Candidate],
    /// All columns, the target last.
    columns: Vec<&'a [f64]>,
    weight: &'a [f64],
    /// Training rows in parts, whose products are summed part by part, as in a system.
    parts: Vec<Vec<usize>>,
}

impl<'a> Rough<'a> {
    pub fn new(base: &'a [Vec<f64>], candidates: &'a [Candidate], y: &'a [f64], layout: &'a Layout) -> Self {
        let columns = columns_of(base, candidates, y);
        if columns.len() < PANEL {
            let system = System::new(base, candidates, y, layout, Vec::new());
            return Self { system, candidates, columns, weight: &layout.weight, parts: Vec::new() };
        }
        let uses = uses(layout);
        let of = |wanted: Use| (0..uses.len()).filter(|i| uses[*i] == wanted).collect::<Vec<usize>>();
        let parts: Vec<Vec<usize>> =
            std::iter::once(of(Use::Always)).chain((0..FOLDS).map(|fold| of(Use::Fold(fold)))).collect();
        let count = parts.iter().map(|part| counted(part, layout)).fold(0.0, |sum, part| sum + part);
        let system = System {
            train: DMatrix::from_element(columns.len(), columns.len(), f64::NAN),
            rows: count,
            folds: Vec::new(),
            places: places(base.len(), candidates),
            base: base.len(),
            coefficients: Vec::new(),
            resisting: Vec::new(),
            pieces: Vec::new(),
            uses,
            energy: Vec::new(),
            always: DMatrix::zeros(0, 0),
            whitened: Vec::new(),
        };
        let mut rough = Self { system, candidates, columns, weight: &layout.weight, parts };
        rough.begin();
        rough
    }

    pub fn system(&self) -> &System {
        &self.system
    }

    /// Computes the products of the model and the target with everything, and of each candidate's columns with each
    /// other.
    fn begin(&mut self) {
        let (base, target) = (self.system.base, self.system.target());
        let model: Vec<usize> = (0..base).chain([target]).collect();
        let mut strips: Vec<Vec<usize>> = vec![model.clone()];
        for place in &self.system.places {
            match strips.last_mut().filter(|strip| strip.len() < STRIP) {
                Some(strip) => strip.extend(place.clone()),
                None => strips.push(place.clone().collect()),
            }
        }
        self.learn(&strips, &model, true);
        let System { train, uses, .. } = &self.system;
        let columns = Weighed { columns: &self.columns, weight: self.weight };
        self.system.energy = energy(train, &columns, uses, &vec![true; uses.len()]);
    }

    fn learn(&mut self, strips: &[Vec<usize>], with: &[usize], own: bool) {
        let columns = Weighed { columns: &self.columns, weight: self.weight };
        let parts = self.parts.iter().map(|part| columns.products(strips, with, own, part));
        let add = |mut sums: Vec<DMatrix<f64>>, more: Vec<DMatrix<f64>>| {
            sums.iter_mut().zip(&more).for_each(|(sum, more)| *sum += more);
            sums
        };
        for (strip, sum) in strips.iter().zip(parts.reduce(add).unwrap_or_default()) {
            let beside = with.iter().chain(if own { strip.as_slice() } else { &[] });
            for (b, products) in beside.zip(sum.column_iter()) {
                for (a, product) in strip.iter().zip(products.iter()) {
                    self.system.train[(*a, *b)] = *product;
                    self.system.train[(*b, *a)] = *product;
                }
            }
        }
    }

    fn columns_of(&self, candidates: &[usize]) -> Vec<usize> {
        candidates.iter().flat_map(|c| self.system.places[*c].clone()).collect()
    }

    /// The best few candidates, justified or not: the whitening must not absorb them.
    pub fn greedy(&mut self) -> Vec<usize> {
        let (mut chosen, mut known): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
        loop {
            let (system, candidates) = (&self.system, self.candidates);
            let selection = Stepwise::of_each(system, candidates);
            if chosen.len() == selection.most() {
                return chosen;
            }
            let priced = selection.priced(&chosen);
            let Some((best, _)) = cheapest(priced.iter().copied()).filter(|(_, price)| price.is_finite()) else {
                return chosen;
            };
            chosen.push(best);
            if known.contains(&best) {
                continue;
            }
            // The same pass also computes products of other likely next causes. Candidates that may join the chosen
            // ones:
            let open: Vec<usize> = selection.open(&chosen).collect();
            let strips: Vec<Vec<usize>> = self.columns_of(&open).chunks(STRIP).map(<[usize]>::to_vec).collect();
            let ahead = likely(&priced, &open, candidates);
            let with: Vec<usize> = std::iter::once(best).chain(ahead).collect();
            self.learn(&strips, &self.columns_of(&with), false);
            known.extend(with);
        }
    }
}

/// The best candidates of some other causes that may still join.
fn likely(priced: &[(usize, f64)], open: &[usize], candidates: &[Candidate]) -> Vec<usize> {
    let mut others: Vec<(usize, f64)> = priced.iter().filter(|(c, _)| open.contains(c)).copied().collect();
    others.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut ahead: Vec<usize> = Vec::new();
    for (c, _) in others {
        if ahead.len() < LIKELY_CAUSES && ahead.iter().all(|known| candidates[*known].id != candidates[c].id) {
            ahead.push(c);
        }
    }
    ahead
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::law::Kind;

    #[test]
    fn a_quick_look_finds_to_the_bit_what_all_products_tell() {
        let wave = |c: usize, i: usize| (0.011 * (i * (c + 3)) as f64).sin();
        let column = |c: usize| (0..900).map(|i| wave(c, i)).collect::<Vec<f64>>();
        let base = vec![column(0), vec![1.0; 900]];
        let of = |c: usize| {
            let columns = (0..=c % 2).map(|k| column(5 + 3 * c + k)).collect::<Vec<_>>();
            let linear = columns.iter().map(|_| ("a", "N")).collect();
            // Every id is there twice.
            let ids = ["a", "b", "c", "d", "e", "f", "g", "h"];
            Candidate::several(ids[c % ids.len()], Kind::Plant, columns, linear)
        };
        let candidates: Vec<Candidate> = (0..60).map(of).collect();
        let noise = |i: usize| (7.1 * (i * i % 977) as f64).sin();
        let y: Vec<f64> = (0..900)
            .map(|i| wave(0, i) + 0.5 * wave(5 + 3 * 17, i) - 0.2 * wave(5 + 3 * 40, i) + 0.1 * noise(i))
            .collect();
        let weight: Vec<f64> = (0..900).map(|i| if i % 50 < 5 { 0.3 } else { 1.0 }).collect();
        let layout = Layout::of(vec![0; 900], &[true; 900], 0.01).weighted(weight);
        let mut rough = Rough::new(&base, &candidates, &y, &layout);
        let chosen = rough.greedy();
        assert!(chosen.len() > 2 && chosen.contains(&17) && chosen.contains(&40), "{chosen:?}");
        let whole = System::new(&base, &candidates, &y, &layout, Vec::new());
        assert_eq!(rough.system.rows.to_bits(), whole.rows.to_bits());
        let bits = |energy: &[(f64, f64)]| energy.iter().map(|(a, b)| [a.to_bits(), b.to_bits()]).collect::<Vec<_>>();
        assert_eq!(bits(&rough.system.energy), bits(&whole.energy));
        let mut columns = whole.columns(&chosen);
        columns.push(whole.target());
        for a in &columns {
            for b in &columns {
                assert_eq!(rough.system.train[(*a, *b)].to_bits(), whole.train[(*a, *b)].to_bits(), "{a} {b}");
            }
        }
        let selection = Stepwise::of_each(&whole, &candidates);
        let mut wanted = Vec::new();
        while wanted.len() < selection.most() {
            wanted.extend(cheapest(selection.priced(&wanted)).map(|(best, _)| best));
        }
        assert_eq!(chosen, wanted);
        // Products that were not requested stay NaN.
        assert!(rough.system.train.iter().any(|product| product.is_nan()));
    }
}
