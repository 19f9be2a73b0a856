//! Mirrored axes of two fingers that hold an object between them. The object pushes back along the line between the
//! tips, keeps its width while carried, moves with both, and weighs down on both once it is lifted.
//!
//! These laws hold for any grip and object, so they are tested before the recording is segmented.

use super::rate_signs::{CORRELATED, mirrored, with_rates_of_motion};
use super::sample_faults;
use crate::diagnose::contract::Cause;
use crate::diagnose::data::limits::{CERTAIN, HALF, LEAST_PHASE_SAMPLES};
use estimation::segment::threshold::percentile;
use foundation::signal::noise::white_noise;
use foundation::signal::task::{Tip, is_two_fingered};
use foundation::words::amount;
use haptics::Vec2;
use haptics::recording::Recording;
use std::ops::Range;

/// Least force of a press, as a share of the usual grip, or of the strongest press against a stop; and of the usual grip,
/// as a share of the usual push: without it, 10 of 20 drifts of a free finger "pressed" with a wrong sign.
/// Choice: halved, 3 of 24 answers change; doubled, 4 of 24 answers change (1 to wrong).
pub(crate) const PRESSING: f64 = 0.4;
/// Least travel in a grip, as a share of the largest range of a tip.
/// Choice: halved or doubled, none of 24 answers changes.
const TRAVEL: f64 = 0.03;
/// Largest motion of a constant dimension, as a share of the travel of either finger.
/// Choice: no case of the ablation reads it.
const STAYS: f64 = 0.1;
/// Rise up to which an object still stands, as a share of the least travel.
/// Choice: halved or doubled, none of 3 answers changes.
const STANDING: f64 = 0.25;
/// Share of its rise from which an object is lifted.
/// Choice: halved or doubled, none of 3 answers changes.
const LIFTED: f64 = 0.6;
/// Least ratio of the changes at a lift: difference of the vertical forces over their sum.
/// Choice: halved or doubled, none of 3 answers changes.
const DIFFERS: f64 = 2.0;

/// A channel of each finger along one axis.
type Pair = [Vec<f64>; 2];

/// The recording with mirrored axes of its fingers put right, and what they were; nothing where all makes sense or no
/// grip tells.
pub fn upright(recording: &Recording) -> Option<(Recording, Cause)> {
    // A place that is mirrored beside a rate that is right looks like the rate's fault first; with both turned it is
    // told from a grip.
    let (straight, rate) = with_rates_of_motion(recording);
    let found = Grips::of(&straight).and_then(|grips| {
        (grips.places(&straight))
            .or_else(|| grips.across(&straight))
            .or_else(|| grips.upwards(&straight))
            .or_else(|| grips.alone(&straight))
    });
    let Some(Found { axes, why }) = found else {
        return rate.map(|rate| (straight.into_owned(), sample_faults::against_motion(rate)));
    };
    let cause = sample_faults::wrong_sign(&axes.join(" and "), why);
    let rates: Vec<String> =
        axes.iter().filter_map(|name| Some(format!("v{}_m_s", name.strip_suffix("_m")?))).collect();
    let names: Vec<&str> = axes.iter().chain(&rates).map(String::as_str).collect();
    Some((mirrored(&straight, &names), cause))
}

/// False if both fingers press and one of them pulls away from the other: nothing can be held like that. The difference of
/// two gripping forces shows no load, so a wrong sign takes every effect out of the residual.
pub fn is_plausible(recording: &Recording) -> bool {
    Grips::of(recording).is_none_or(|grips| grips.across(recording).is_none())
}

/// Mirrored axes, and the sentence with the reason.
struct Found {
    axes: Vec<String>,
    why: String,
}

/// Segments in which both fingers press, and the signals of the fingers.
struct Grips {
    spans: Vec<Range<usize>>,
    /// Threshold of pressing, N, and least travel, m.
    least_n: f64,
    travel_m: f64,
    x: Pair,
    y: Pair,
    fx: Pair,
    fy: Pair,
}

impl Grips {
    fn of(recording: &Recording) -> Option<Self> {
        if !is_two_fingered(recording) {
            return None;
        }
        let tips = [Tip::of(recording, "1").ok()?, Tip::of(recording, "2").ok()?];
        let place = |axis: fn(Vec2) -> f64| -> Pair {
            [0, 1].map(|k| (0..recording.len()).map(|i| axis(tips[k].position(i))).collect())
        };
        let force = |axis: &str| -> Option<Pair> {
            let of = |k: usize| Some(recording.channel(&format!("f{axis}{k}_N"))?.to_vec());
            Some([of(1)?, of(2)?])
        };
        let [fx, fy] = [force("x")?, force("y")?];
        let size = |k: usize, i: usize| fx[k][i].hypot(fy[k][i]);
        let weaker = |i: usize| size(0, i).min(size(1, i));
        let stronger = |i: usize| size(0, i).max(size(1, i));
        let noise = [&fx[0], &fx[1], &fy[0], &fy[1]].map(|f| white_noise(f)).into_iter().fold(0.0, f64::max);
        let usual = |force: &dyn Fn(usize) -> f64| {
            let mut all: Vec<f64> = (0..recording.len()).map(force).collect();
            percentile(&mut all, 0.95)
        };
        let [grip, push] = [usual(&weaker), usual(&stronger)];
        let [least, least_n] = [grip, push].map(|force| (PRESSING * force).max(CERTAIN * noise));
        let mut spans: Vec<Range<usize>> = Vec::new();
        let mut is_held = false;
        for i in 0..recording.len() {
            // A grip that becomes weaker while it carries is no second one: that would begin in the air.
            let share = if is_held { HALF } else { 1.0 };
            is_held = grip > PRESSING * push && weaker(i) > share * least;
            match spans.last_mut() {
                Some(last) if is_held && last.end == i => last.end = i + 1,
                _ if is_held => spans.push(i..i + 1),
                _ => {}
            }
        }
        spans.retain(|s| s.len() >= LEAST_PHASE_SAMPLES);
        let [x, y] = [place(|p| p.x), place(|p| p.y)];
        let range_m = |of: &Vec<f64>| {
            let (low, high) = of.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
            high - low
        };
        let travel_m = TRAVEL * x.iter().chain(&y).map(range_m).fold(0.0, f64::max);
        // The tips of a grip move together, or as mirror images. Otherwise the object turned in it, or slipped out.
        spans.retain(|span| {
            [&x, &y].iter().all(|[one, two]| {
                let [apart, sum] = [-1.0, 1.0].map(|side| spread(span, &|i| two[i] + side * one[i]));
                apart.min(sum) < travel_m.max(STAYS * apart.max(sum))
            })
        });
        (least_n > 0.0).then_some(Self { spans, least_n, travel_m, x, y, fx, fy })
    }

    fn samples(&self) -> impl Iterator<Item = usize> + '_ {
        self.spans.iter().cloned().flatten()
    }

    fn mean(&self, of: impl Fn(usize) -> f64) -> f64 {
        let (sum, n) = self.samples().fold((0.0, 0_u32), |(sum, n), i| (sum + of(i), n + 1));
        sum / f64::from(n.max(1))
    }

    /// RMS variation of `of` within the grips, each about its own mean.
    fn moves(&self, of: impl Fn(usize) -> f64) -> f64 {
        let (mut power, mut n) = (0.0, 0);
        for span in &self.spans {
            power += spread(span, &of).powi(2) * span.len() as f64;
            n += span.len();
        }
        (power / n.max(1) as f64).sqrt()
    }

    /// A tip that moves opposite to the other one, along x or y.
    fn places(&self, recording: &Recording) -> Option<Found> {
        recording.channel("x1_m")?;
        for (axis, at) in [("x", &self.x), ("y", &self.y)] {
            let apart = self.moves(|i| at[1][i] - at[0][i]);
            let sum = self.moves(|i| at[1][i] + at[0][i]);
            if 0.5 * apart > self.travel_m && sum < STAYS * apart {
                let finger = if axis == "x" { self.crossed() } else { self.sinking() };
                let why = format!(
                    "while both fingers press, tip {} moves along {axis} as the mirror image of the other one: what they hold would change its size by {}",
                    finger + 1,
                    amount(2.0 * apart, "m")
                );
                return Some(Found { axes: vec![format!("{axis}{}_m", finger + 1)], why });
            }
        }
        None
    }

    /// The finger whose x axis, mirrored, puts the second tip to the right of the first.
    fn crossed(&self) -> usize {
        usize::from(self.mean(|i| self.x[1][i] + self.x[0][i]) < 0.0)
    }

    /// The finger that moves down first in a grip: a standing object can only be lifted.
    fn sinking(&self) -> usize {
        let first = self.spans.iter().find_map(|span| {
            let moved = |i: &usize| (self.y[0][*i] - self.y[0][span.start]).abs() > self.travel_m;
            span.clone().find(moved).map(|i| self.y[0][i] - self.y[0][span.start])
        });
        usize::from(first.is_some_and(|rise| rise > 0.0))
    }

    /// A finger that pushes alone: it pushes away from itself, and a yielding object moves with it.
    fn alone(&self, recording: &Recording) -> Option<Found> {
        for k in [0, 1] {
            let size = |k: usize, i: usize| self.fx[k][i].hypot(self.fy[k][i]);
            let pushes = |i: &usize| size(k, *i) > self.least_n && size(1 - k, *i) < PRESSING * size(k, *i);
            let samples: Vec<usize> = (0..recording.len()).filter(pushes).collect();
            let sum = |f: &dyn Fn(usize) -> f64| samples.iter().map(|i| f(*i)).sum::<f64>();
            let [along, across] = [&self.fx[k], &self.fy[k]].map(|f| sum(&|i| f[i].abs()));
            if samples.len() < LEAST_PHASE_SAMPLES || across > 0.5 * along {
                continue;
            }
            let outwards = if k == 0 { sum(&|i| self.fx[k][i]) } else { -sum(&|i| self.fx[k][i]) };
            let name = k + 1;
            if outwards < -CORRELATED * along {
                let why = format!("finger {name} pushes alone, and fx{name}_N pulls: a finger can only push");
                return Some(Found { axes: vec![format!("fx{name}_N")], why });
            }
            let step = |i: usize| if i == 0 { 0.0 } else { self.x[k][i] - self.x[k][i - 1] };
            let [work, all] = [sum(&|i| self.fx[k][i] * step(i)), along / samples.len() as f64 * self.travel_m];
            if work < -all && recording.channel("x1_m").is_some() {
                let why = format!(
                    "what finger {name} pushes alone comes towards it all the way: it would be drawn, not pushed"
                );
                return Some(Found { axes: vec![format!("x{name}_m")], why });
            }
        }
        None
    }

    /// Forces along x that do not press the held object together.
    fn across(&self, recording: &Recording) -> Option<Found> {
        if self.spans.is_empty() {
            return None;
        }
        let [one, two] = &self.fx;
        let size = |f: &[f64]| self.mean(|i| f[i] * f[i]).sqrt();
        let together = self.mean(|i| one[i] * two[i]) / (size(one) * size(two)).max(f64::MIN_POSITIVE);
        if together.abs() < CORRELATED {
            return None;
        }
        let pulls = [self.mean(|i| one[i]) < 0.0, self.mean(|i| two[i]) > 0.0];
        if self.mean(|i| self.x[1][i] - self.x[0][i]) <= 0.0 {
            // The first finger is the left one. If it presses to the right, its tip is on the right of the other.
            let both = pulls == [false, false] && recording.channel("x1_m").is_some();
            let why =
                "while both fingers press, the first one stands to the right of the other and pushes to the right"
                    .to_owned();
            return both.then(|| Found { axes: vec!["x1_m".to_owned(), "x2_m".to_owned()], why });
        }
        let axes: Vec<String> =
            [1, 2].into_iter().filter(|k| pulls[k - 1]).map(|k: usize| format!("fx{k}_N")).collect();
        let who = axes.join(" and ");
        let why =
            format!("while both fingers press, {who} pulls away from the other finger; nothing can be held like that");
        (!axes.is_empty()).then_some(Found { axes, why })
    }

    /// A vertical force that falls when it takes over the weight, or heights that fall when an object is lifted.
    fn upwards(&self, recording: &Recording) -> Option<Found> {
        let lifts: Vec<Lift> = self.spans.iter().filter_map(|span| self.lift(span)).collect();
        let down = lifts.iter().filter(|l| l.downwards).count();
        if lifts.is_empty() || (down > 0 && down < lifts.len()) {
            return None;
        }
        let [one, two] = [0, 1].map(|k| lifts.iter().map(|l| l.gained_n[k]).sum::<f64>());
        let noise = white_noise(&self.fy[0]).max(white_noise(&self.fy[1]));
        if (one - two).abs().max((one + two).abs()) < CERTAIN * noise {
            return None;
        }
        let all = |axis: &str, unit: &str| [1, 2].map(|k| format!("{axis}{k}_{unit}")).to_vec();
        let axes = match ((one - two).abs() > DIFFERS * (one + two).abs(), down > 0) {
            (true, false) => vec![format!("fy{}_N", if one < two { 1 } else { 2 })],
            (false, false) if one < 0.0 && two < 0.0 => all("fy", "N"),
            (false, true) if one > 0.0 && two > 0.0 && recording.channel("y1_m").is_some() => all("y", "m"),
            _ => return None,
        };
        let who = axes.join(" and ");
        let why = if down > 0 {
            format!(
                "{who} fall while the weight of what was gripped comes onto the fingers: what stands is lifted upwards"
            )
        } else {
            format!("{who} falls when what the fingers hold is lifted: its weight would pull upwards")
        };
        Some(Found { axes, why })
    }

    /// Changes of the vertical forces in a grip between the standing and the lifted object.
    fn lift(&self, span: &Range<usize>) -> Option<Lift> {
        let height = |i: usize| 0.5 * (self.y[0][i] + self.y[1][i]);
        let start = height(span.start);
        let first = span.clone().map(height).find(|h| (h - start).abs() > self.travel_m)?;
        let downwards = first < start;
        let rise = |i: usize| if downwards { start - height(i) } else { height(i) - start };
        let top = span.clone().map(rise).fold(0.0, f64::max);
        let stands: Vec<usize> = span.clone().take_while(|i| rise(*i).abs() < STANDING * self.travel_m).collect();
        let lifted: Vec<usize> = span.clone().filter(|i| rise(*i) > LIFTED * top).collect();
        let mean = |rows: &[usize], f: &[f64]| rows.iter().map(|i| f[*i]).sum::<f64>() / rows.len().max(1) as f64;
        let gained_n = [0, 1].map(|k| mean(&lifted, &self.fy[k]) - mean(&stands, &self.fy[k]));
        Some(Lift { gained_n, downwards })
    }
}

/// RMS variation of `of` about its mean in a segment.
fn spread(span: &Range<usize>, of: &dyn Fn(usize) -> f64) -> f64 {
    let mean_of = |of: &dyn Fn(usize) -> f64| span.clone().map(of).sum::<f64>() / span.len().max(1) as f64;
    let mean = mean_of(of);
    mean_of(&|i| (of(i) - mean).powi(2)).sqrt()
}

struct Lift {
    /// Change of the vertical force of either finger, N.
    gained_n: [f64; 2],
    /// True if the recorded height decreased.
    downwards: bool,
}
