//! Curves computed from others: transforms and residuals. Each is made once, in the background where that takes longer
//! than a frame allows, and kept while it is shown.

use super::levels::Levels;
use crate::ui::background::jobs::{JobKind, Jobs, Started, Ticket, change, no_change};
use crate::ui::document::prepared::Prepared;
use estimator::signal::transform::{Transform, mean};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Computing curves for plots.
const CURVES: JobKind = JobKind::new("curves");

/// Number of samples that may be computed within a frame, 3 to 6 ms; larger curves are computed by a job.
const AT_ONCE: usize = 150_000;

/// Definition of a derived curve.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// Recording of the curve.
    pub prepared: Arc<Prepared>,
    /// Curve to start from.
    pub of: Arc<Levels>,
    /// Curve to subtract.
    pub less: Option<Arc<Levels>>,
    /// Transform applied to the difference.
    pub transform: Transform,
}

/// Identity of a recipe. Its targets live as long as the entry that has it for a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Key {
    of: usize,
    less: usize,
    transform: (u8, u64),
}

impl Recipe {
    fn key(&self) -> Key {
        let transform = match self.transform {
            Transform::None => (0, 0),
            Transform::Derivative => (1, 0),
            Transform::SecondDerivative => (2, 0),
            Transform::LowPass(cutoff_hz) => (3, cutoff_hz.to_bits()),
            Transform::Integral => (4, 0),
            Transform::MinusMean => (5, 0),
        };
        Key {
            of: Arc::as_ptr(&self.of) as usize,
            less: self.less.as_ref().map_or(0, |l| Arc::as_ptr(l) as usize),
            transform,
        }
    }

    fn cost(&self) -> usize {
        self.prepared.times.len()
    }

    /// Computes the curve.
    pub fn cook(&self) -> Levels {
        let recording = &self.prepared.recording;
        let left = self.less.as_ref().map(|less| Arc::new(Levels::difference(&self.of, less, recording)));
        let curve = left.as_ref().unwrap_or(&self.of);
        if self.transform == Transform::None {
            return Levels::clone(curve);
        }
        let samples = curve.samples(recording);
        let values: Vec<f64> = (0..samples.len()).map(|i| samples.value(i)).collect();
        match self.transform {
            Transform::MinusMean => curve.shifted(-mean(&values)),
            other => Levels::new(other.apply(&self.prepared.times, &values)),
        }
    }
}

#[derive(Debug)]
struct Cooked {
    /// Keeps the targets of the key alive.
    _recipe: Recipe,
    levels: Arc<Levels>,
}

/// A recipe and its curve.
type Made = (Recipe, Arc<Levels>);

/// Cache of derived curves, and the recipes still requested.
#[derive(Debug, Default)]
pub struct Derived {
    cooked: HashMap<Key, Cooked>,
    wanted: Vec<Recipe>,
    used: HashSet<Key>,
    spent: usize,
}

impl Derived {
    /// Curve of a recipe; `None` while it is missing, in which case a job is requested.
    pub fn get(&mut self, recipe: &Recipe) -> Option<Arc<Levels>> {
        if recipe.less.is_none() && recipe.transform == Transform::None {
            return Some(Arc::clone(&recipe.of));
        }
        let key = recipe.key();
        self.used.insert(key);
        if let Some(cooked) = self.cooked.get(&key) {
            return Some(Arc::clone(&cooked.levels));
        }
        if self.spent + recipe.cost() <= AT_ONCE {
            self.spent += recipe.cost();
            let levels = Arc::new(recipe.cook());
            self.cooked.insert(key, Cooked { _recipe: recipe.clone(), levels: Arc::clone(&levels) });
            return Some(levels);
        }
        if !self.wanted.iter().any(|w| w.key() == key) {
            self.wanted.push(recipe.clone());
        }
        None
    }

    /// Curve of a recipe if it is in the cache.
    pub fn peek(&mut self, recipe: &Recipe) -> Option<Arc<Levels>> {
        if recipe.less.is_none() && recipe.transform == Transform::None {
            return Some(Arc::clone(&recipe.of));
        }
        self.used.insert(recipe.key());
        self.cooked.get(&recipe.key()).map(|cooked| Arc::clone(&cooked.levels))
    }

    /// At the end of a picture: what nobody looked at is let go, what is missing is begun. The job brings it to `store`.
    pub fn settle<'a, T: 'static>(
        &mut self,
        ctx: &egui::Context,
        jobs: &'a mut Jobs<T>,
        store: fn(&mut T) -> &mut Self,
    ) -> Option<Started<'a, T>> {
        let used = std::mem::take(&mut self.used);
        self.cooked.retain(|key, _| used.contains(key));
        self.spent = 0;
        let wanted = std::mem::take(&mut self.wanted);
        // One job at a time: recipes that are still needed are requested again in the next frame.
        if wanted.is_empty() || jobs.is_running(CURVES) {
            return None;
        }
        Some(jobs.start(ctx, CURVES, "Computing curves", move |ticket| match cook(wanted, ticket) {
            Some(made) => change(move |to: &mut T, _| store(to).take(made)),
            None => no_change(),
        }))
    }

    /// Stores the curves of a finished job.
    fn take(&mut self, made: Vec<Made>) {
        for (recipe, levels) in made {
            let key = recipe.key();
            // Kept until the next frame shows that nobody uses it.
            self.used.insert(key);
            self.cooked.insert(key, Cooked { _recipe: recipe, levels });
        }
    }

    /// Number of cached curves.
    pub fn len(&self) -> usize {
        self.cooked.len()
    }

    /// True if the cache is empty.
    pub fn is_empty(&self) -> bool {
        self.cooked.is_empty()
    }
}

fn cook(wanted: Vec<Recipe>, ticket: &Ticket) -> Option<Vec<Made>> {
    let count = wanted.len();
    let mut made = Vec::with_capacity(count);
    for (k, recipe) in wanted.into_iter().enumerate() {
        if ticket.cancelled().load(Ordering::Relaxed) {
            return None;
        }
        let levels = Arc::new(recipe.cook());
        made.push((recipe, levels));
        ticket.tell((k + 1) as f64 / count as f64);
    }
    Some(made)
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::{Channel, Recording};

    fn prepared(n: usize) -> Arc<Prepared> {
        let values = (0..n).map(|i| (i as f64 * 0.01).sin() + 0.3).collect();
        let channel = Channel { name: "f_N".into(), unit: "N".into(), values };
        let time_s = Some((0..n).map(|i| i as f64 * 1e-3).collect());
        Arc::new(Prepared::new(Recording { time_s, channels: vec![channel], ..Recording::default() }))
    }

    fn recipe(prepared: &Arc<Prepared>, transform: Transform) -> Recipe {
        let of = Arc::clone(&prepared.groups[0].traces[0].levels);
        Recipe { prepared: Arc::clone(prepared), of, less: None, transform }
    }

    #[test]
    fn short_curves_are_there_at_once_long_ones_after_a_job() {
        let (ctx, mut jobs, mut store) = (egui::Context::default(), Jobs::<Derived>::default(), Derived::default());
        let short = prepared(1_000);
        let slope = store.get(&recipe(&short, Transform::Derivative)).expect("at once");
        let expected = 10.0 * (0.01 * 500.0_f64).cos();
        assert!((slope.samples(&short.recording).value(500) - expected).abs() < 1e-3);
        let long = prepared(AT_ONCE + 1);
        assert!(store.get(&recipe(&long, Transform::Derivative)).is_none());
        store.settle(&ctx, &mut jobs, |derived| derived);
        let begun = std::time::Instant::now();
        while store.peek(&recipe(&long, Transform::Derivative)).is_none() {
            assert!(begun.elapsed().as_secs() < 20, "the job brings it");
            for answer in jobs.poll() {
                answer.expect("curves")(&mut store, &ctx);
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
    }

    #[test]
    fn what_nobody_looks_at_is_let_go() {
        let (ctx, mut jobs, mut store) = (egui::Context::default(), Jobs::<Derived>::default(), Derived::default());
        let short = prepared(1_000);
        for cutoff_hz in [5.0, 6.0, 7.0] {
            assert!(store.get(&recipe(&short, Transform::LowPass(cutoff_hz))).is_some());
            store.settle(&ctx, &mut jobs, |derived| derived);
            assert_eq!(store.len(), 1, "only the cut-off that is shown");
        }
        store.settle(&ctx, &mut jobs, |derived| derived);
        assert!(store.is_empty());
    }

    #[test]
    fn what_is_left_is_the_difference_and_less_its_mean_it_shares_its_samples() {
        let short = prepared(5_000);
        let of = Arc::clone(&short.groups[0].traces[0].levels);
        let less = Arc::new(Levels::new(vec![0.25; 5_000]));
        let mut recipe =
            Recipe { prepared: Arc::clone(&short), of, less: Some(Arc::clone(&less)), transform: Transform::None };
        let left = recipe.cook();
        let measured = short.recording.channel("f_N").expect("there");
        assert_eq!(left.samples(&short.recording).value(77), measured[77] - 0.25);
        let (low, high) = left.samples(&short.recording).range(0, 5_000);
        assert!((low + 0.95).abs() < 1e-4 && (high - 1.05).abs() < 1e-4, "{low} {high}");
        recipe.transform = Transform::MinusMean;
        let centred = recipe.cook();
        let mean = measured.iter().sum::<f64>() / 5_000.0;
        assert!((centred.samples(&short.recording).value(77) - (measured[77] - mean)).abs() < 1e-9);
    }
}
