//! The kind of joint of generated paths, beside Sturm's BIC rule on the same paths in the same run.
//!
//! Seeds 0 … 999 and 100000 … 101999 were looked at while the rules were made; `TOUCHSTONE_SEED` draws others. The figures and the seeds they were
//! taken on are in `docs/constraints.md`.

mod generator;
mod sturm;

use estimator::constraint;
use estimator::estimate::ConstraintKind;
use generator::{Drawn, Truth, draw};
use nalgebra::Vector3;
use sturm::Answer;

const PATHS: u64 = 200;

fn first_seed() -> u64 {
    std::env::var("TOUCHSTONE_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(0)
}

/// What was right, confidently wrong, and left open.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    right: usize,
    wrong: usize,
    open: usize,
}

impl Score {
    fn add(&mut self, right: Option<bool>) {
        match right {
            Some(true) => self.right += 1,
            Some(false) => self.wrong += 1,
            None => self.open += 1,
        }
    }

    fn total(&self) -> usize {
        self.right + self.wrong + self.open
    }

    fn accuracy(&self) -> f64 {
        self.right as f64 / self.total().max(1) as f64
    }
}

fn fits(kind: ConstraintKind, truth: Truth) -> bool {
    match kind {
        ConstraintKind::Revolute => truth == Truth::Revolute,
        ConstraintKind::Prismatic => truth == Truth::Prismatic,
        ConstraintKind::Free => truth == Truth::Free,
        ConstraintKind::Spline => truth == Truth::Spline,
        _ => false,
    }
}

/// The decision, the likelier kind where there is none, and words.
fn ours(drawn: &Drawn) -> (Option<bool>, bool, String) {
    let Some(found) = constraint::detect_in(&drawn.recording) else { return (None, false, String::new()) };
    let decided = (found.kind != ConstraintKind::Undecided).then(|| fits(found.kind, drawn.truth));
    let forced = decided.unwrap_or_else(|| found.leaning.is_some_and(|l| fits(l.kind, drawn.truth)));
    (decided, forced, format!("{:?} {:?}: {}", found.kind, found.leaning, found.evidence))
}

/// The rule always answers; it has no word for a spline.
fn peer(drawn: &Drawn, rotational_extra: f64) -> Option<bool> {
    let z = drawn.recording.channel("z_m");
    let (x, y) = (drawn.recording.channel("x_m")?, drawn.recording.channel("y_m")?);
    let points: Vec<Vector3<f64>> = (0..x.len()).map(|i| Vector3::new(x[i], y[i], z.map_or(0.0, |z| z[i]))).collect();
    Some(match sturm::decide(&points, rotational_extra, 7) {
        Answer::Rotational => drawn.truth == Truth::Revolute,
        Answer::Prismatic => drawn.truth == Truth::Prismatic,
        Answer::Free => drawn.truth == Truth::Free,
        Answer::Rigid => false,
    })
}

#[test]
fn kinds_of_generated_paths_are_told_more_often_and_less_wrongly_than_by_the_bic_rule() {
    // By truth, and all together: ours, ours where the likelier kind stands in for undecided, the peer as published, the peer with three parameters more for a rotation.
    let mut scores: std::collections::BTreeMap<Option<Truth>, [Score; 4]> = std::collections::BTreeMap::new();
    let first = first_seed();
    for seed in first..first + PATHS {
        let drawn = draw(seed);
        let (right, forced, answer) = ours(&drawn);
        if right != Some(true) {
            println!("{seed}: {right:?} {} → {answer}", drawn.about);
        }
        let results = [right, Some(forced), peer(&drawn, 0.0), peer(&drawn, 3.0)];
        for key in [None, Some(drawn.truth)] {
            let row = scores.entry(key).or_default();
            row.iter_mut().zip(results).for_each(|(score, result)| score.add(result));
        }
    }
    println!("seeds {first} to {}", first + PATHS - 1);
    for (truth, row) in &scores {
        let name = truth.map_or("all".to_owned(), |t| format!("{t:?}"));
        for (who, score) in ["ours", "ours, when forced", "BIC rule", "BIC rule, rotation +3"].iter().zip(row) {
            println!(
                "{name:<10} {who:<22} right {:>3}, wrong {:>3}, left open {:>3} of {:>3}: accuracy {:.3}",
                score.right,
                score.wrong,
                score.open,
                score.total(),
                score.accuracy()
            );
        }
    }
    let kind = |truth: Truth, k: usize| scores[&Some(truth)][k];
    let joints = |k: usize| {
        let (a, b) = (kind(Truth::Revolute, k), kind(Truth::Prismatic, k));
        Score { right: a.right + b.right, wrong: a.wrong + b.wrong, open: a.open + b.open }
    };
    let [ours, forced, published, heavier] = scores[&None];
    println!("hinges and slides only: {:?}", [0, 1, 2, 3].map(joints));
    for (k, other) in [(2, published), (3, heavier)] {
        assert!(ours.accuracy() > other.accuracy(), "{ours:?} beside {other:?}");
        assert!(4 * ours.wrong <= other.wrong, "{ours:?} beside {other:?}");
        // On hinges and slides alone, too, although the rule has no word for doubt and *undecided* counts as not right here.
        assert!(joints(0).accuracy() > joints(k).accuracy(), "{:?} beside {:?}", joints(0), joints(k));
        assert!(4 * joints(0).wrong <= joints(k).wrong, "{:?} beside {:?}", joints(0), joints(k));
        assert!(forced.accuracy() > other.accuracy(), "{forced:?} beside {other:?}");
    }
    // And in each group beside the rule as published. (Whoever never sees a hinge is right about every slide.)
    for truth in [Truth::Revolute, Truth::Prismatic, Truth::Free, Truth::Spline] {
        let (ours, rule) = (kind(truth, 0), kind(truth, 2));
        assert!(ours.accuracy() >= rule.accuracy(), "{truth:?}: {ours:?} beside {rule:?}");
    }
    // Hardly ever wrong with confidence.
    assert!(20 * ours.wrong <= ours.total() && 25 * joints(0).wrong <= joints(0).total(), "{ours:?}");
}
