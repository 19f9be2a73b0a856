//! Pushes of the needle into the sheet: the samples on the first, untouched loading curve, and the place of the
//! puncture.

use super::signals::Along;
use crate::identify::limits::{CONTACT_NOISES, PUSH_SHARE};
use std::ops::Range;

/// Least reversal of the motion, as a share of its whole range.
/// Choice: halved or doubled, none of 15 answers changes.
const STROKE_TURN_SHARE: f64 = 0.05;
/// Largest distance of two places of the same hole, as a share of the dent there.
/// Choice: halved or doubled, none of 15 answers changes.
const SAME_PLACE: f64 = 0.3;
/// Distance beyond an earlier dent from which the sheet is untouched again, as a share of the present one.
/// Choice: halved, 1 of 15 answers change; doubled, 1 of 15 answers change.
const BEYOND_DENT: f64 = 0.03;
/// Share of its peak below which the force of a needle that is through falls.
/// Choice: halved, 0 of 15 answers change; doubled, 9 of 9 answers change (9 to wrong).
const FALLEN: f64 = 0.6;
/// Largest return of the needle meanwhile, as a share of its depth in the sheet: the force of a released press falls
/// with its depth.
/// Choice: halved or doubled, none of 15 answers changes.
const DRAWN_BACK: f64 = 0.1;
/// Number of parts of the way to the sheet, of which the last one shows the holding force of the needle.
/// Choice: halved or doubled, none of 12 answers changes.
const LAST_PART: usize = 4;

/// One push.
#[derive(Clone, Debug)]
pub struct Push {
    /// Index of the hold that it belongs to.
    pub hold: usize,
    /// Samples from the turning point outside up to the puncture or the deepest point.
    pub samples: Range<usize>,
    /// Depth of the earlier pushes at the same place, m; minus infinity for the first one.
    pub dented_to_m: f64,
    /// Depth from which the sheet is untouched, m: everything for the first push at a place.
    pub untouched_from_m: f64,
    /// Depth of the dent: from the first touch to the puncture or to the largest force, m.
    pub dent_m: f64,
    /// The last sample before the force falls, when the needle goes through.
    pub puncture: Option<usize>,
    /// The first sample after it has.
    pub fallen: Option<usize>,
    /// The end of the whole stroke, one past its last sample.
    pub end: usize,
}

struct Place {
    side_m: f64,
    deepest_m: f64,
    punctured: bool,
}

/// All pushes, first to last; pushes into a hole that is there already are left out.
pub fn pushes(along: &Along) -> Vec<Push> {
    let (low, high) = extremes(&along.depth_m, &along.holds);
    let turn_m = STROKE_TURN_SHARE * (high - low);
    let outside_n = quiet_force(along);
    let strongest_n =
        along.holds.iter().flat_map(Clone::clone).map(|i| along.force_n[i] - outside_n).fold(0.0, f64::max);
    let least_n = (PUSH_SHARE * strongest_n).max(CONTACT_NOISES * along.noise_n);
    let mut places: Vec<Place> = Vec::new();
    let mut found = Vec::new();
    for (hold, range) in along.holds.iter().enumerate() {
        for stroke in strokes(&along.depth_m, range, turn_m) {
            let calm = calmed(&along.force_n[stroke.clone()]);
            let force = |i: usize| calm[i - stroke.start] - outside_n;
            let Some(peak) = stroke.clone().max_by(|&a, &b| force(a).total_cmp(&force(b))) else { continue };
            if force(peak) < least_n {
                continue;
            }
            let side_m = along.side_m[peak];
            let Some(touched) = touched(along, &stroke, &force, least_n) else { continue };
            let (puncture, fallen) = puncture(along, &stroke, &force, (least_n, touched)).unzip();
            let end = puncture.unwrap_or(peak) + 1;
            let dent_m = along.depth_m[end - 1] - along.depth_m[touched];
            // A stroke in a hole makes no dent of its own.
            let deepest_m = found.iter().map(|p: &Push| p.dent_m).fold(dent_m, f64::max);
            let known = places.iter().position(|p| (p.side_m - side_m).abs() < SAME_PLACE * deepest_m);
            if known.is_some_and(|k| places[k].punctured) {
                continue;
            }
            let start = held_from(along, &stroke, &force, touched);
            let dented_to_m = known.map_or(f64::NEG_INFINITY, |k| places[k].deepest_m);
            let untouched_from_m = dented_to_m + BEYOND_DENT * deepest_m;
            let samples = start..end;
            found.push(Push {
                hold,
                samples,
                dented_to_m,
                untouched_from_m,
                dent_m,
                puncture,
                fallen,
                end: stroke.end,
            });
            let deepest_m = along.depth_m[stroke.start..stroke.end].iter().fold(f64::MIN, |a, b| a.max(*b));
            match known {
                Some(k) => {
                    places[k].deepest_m = places[k].deepest_m.max(deepest_m);
                    places[k].punctured |= puncture.is_some();
                }
                None => places.push(Place { side_m, deepest_m, punctured: puncture.is_some() }),
            }
        }
    }
    found
}

/// Force while the needle is held and touches nothing: the median of the outer third of the motion.
pub fn quiet_force(along: &Along) -> f64 {
    let (low, high) = extremes(&along.depth_m, &along.holds);
    let outer = low + (high - low) / 3.0;
    let held = along.holds.iter().flat_map(Clone::clone);
    let mut quiet: Vec<f64> = held.filter(|&i| along.depth_m[i] < outer).map(|i| along.force_n[i]).collect();
    quiet.sort_by(f64::total_cmp);
    quiet.get(quiet.len() / 2).copied().unwrap_or(0.0)
}

fn extremes(depth: &[f64], holds: &[Range<usize>]) -> (f64, f64) {
    holds
        .iter()
        .flat_map(Clone::clone)
        .map(|i| depth[i])
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)))
}

/// Strokes inwards: from a turning point outside to the next one inside, turns smaller than `turn_m` aside.
fn strokes(depth: &[f64], range: &Range<usize>, turn_m: f64) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let (mut low, mut high) = (range.start, range.start);
    let mut inwards = false;
    for i in range.clone() {
        if inwards {
            if depth[i] > depth[high] {
                high = i;
            } else if depth[high] - depth[i] > turn_m {
                found.push(low..high + 1);
                (inwards, low) = (false, i);
            }
        } else if depth[i] < depth[low] {
            low = i;
        } else if depth[i] - depth[low] > turn_m {
            (inwards, high) = (true, i);
        }
    }
    if inwards {
        found.push(low..high + 1);
    }
    found
}

/// First touch of the sheet: the force rises out of quiet. A tool that is taken only then shows another force before,
/// which is not the sheet's: it is less than a push (`least_n`).
fn touched(along: &Along, stroke: &Range<usize>, force: &dyn Fn(usize) -> f64, least_n: f64) -> Option<usize> {
    let touches = |i: &usize| force(*i) > CONTACT_NOISES * along.noise_n;
    let quiet = stroke.clone().take_while(|i| force(*i) < least_n).find(|i| !touches(i)).unwrap_or(stroke.start);
    (quiet..stroke.end).find(touches)
}

/// The first sample of a stroke from which the needle is held as on its way to the sheet: a tool that is taken up bears
/// another load before.
fn held_from(along: &Along, stroke: &Range<usize>, force: &dyn Fn(usize) -> f64, touched: usize) -> usize {
    if along.two_fingered {
        return stroke.start;
    }
    let mut near: Vec<f64> = (touched - (touched - stroke.start) / LAST_PART..touched).map(force).collect();
    near.sort_by(f64::total_cmp);
    let Some(level) = near.get(near.len() / 2).copied() else { return stroke.start };
    let other = |i: &usize| (force(*i) - level).abs() > CONTACT_NOISES * along.noise_n;
    let before = stroke.start..touched - (touched - stroke.start) / LAST_PART;
    before.rev().find(other).map_or(stroke.start, |i| i + 1)
}

/// The last sample before the force falls although the needle moves on, and the first one after. A force less than
/// `least_n` is no push.
fn puncture(
    along: &Along,
    stroke: &Range<usize>,
    force: &dyn Fn(usize) -> f64,
    (least_n, touched): (f64, usize),
) -> Option<(usize, usize)> {
    let surface_m = along.depth_m[touched];
    let mut peak = touched;
    for i in touched..stroke.end {
        if force(i) > force(peak) {
            peak = i;
        }
        let drawn_back = along.depth_m[peak] - along.depth_m[i] > DRAWN_BACK * (along.depth_m[peak] - surface_m);
        if force(peak) >= least_n && force(i) < FALLEN * force(peak) && !drawn_back {
            return Some((peak, i));
        }
        // A push that was released this far begins again.
        if force(i) < CONTACT_NOISES * along.noise_n {
            peak = i;
        }
    }
    None
}

/// Medians of five: single wild samples make no peak.
fn calmed(values: &[f64]) -> Vec<f64> {
    (0..values.len())
        .map(|i| {
            let mut near = values[i.saturating_sub(2)..(i + 3).min(values.len())].to_vec();
            near.sort_by(f64::total_cmp);
            near[near.len() / 2]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spring of 450 N/m from depth 0 on, pierced at `puncture_n`, with a way in.
    fn pressed(depth_m: &[f64], puncture_n: f64) -> Along {
        let mut pierced = false;
        let force = |d: &f64| {
            pierced |= 450.0 * d > puncture_n;
            if pierced { 0.02 } else { 450.0 * d.max(0.0) }
        };
        let n = depth_m.len();
        Along {
            force_n: depth_m.iter().map(force).collect(),
            depth_m: depth_m.to_vec(),
            side_m: vec![0.0; n],
            direction: haptics::Vec2::new(0.0, -1.0),
            holds: std::iter::once(0..n).collect(),
            give_m_n: (0.0, 0.0),
            calm: 1,
            period_s: 1e-3,
            noise_n: 0.005,
            free_n: None,
            two_fingered: false,
        }
    }

    /// From 10 mm outside to 2.3 mm, back to 1 mm, and to 6 mm, in steps of 20 µm.
    fn pressed_twice() -> Vec<f64> {
        let legs = [(-10e-3, 2.3e-3), (2.3e-3, 1e-3), (1e-3, 6e-3)];
        let leg = |(from, to): (f64, f64)| {
            let steps = ((to - from).abs() / 2e-5).round();
            (0..steps as usize).map(move |k| from + (to - from) * k as f64 / steps)
        };
        legs.into_iter().flat_map(leg).collect()
    }

    #[test]
    fn a_press_that_is_let_go_is_no_puncture() {
        let along = pressed(&pressed_twice(), 1.6);
        let found = pushes(&along);
        let forces: Vec<f64> = found.iter().filter_map(|p| p.puncture).map(|i| along.force_n[i]).collect();
        assert_eq!(forces.len(), 1, "{found:?}");
        // Steps of 9 mN, of which the median of five takes some.
        assert!((forces[0] - 1.6).abs() < 0.04, "{forces:?}");
        assert!(pushes(&pressed(&pressed_twice(), 9.0)).iter().all(|p| p.puncture.is_none()));
    }

    /// A pen that is taken at once shows no force of its own in its first samples, and the weight of a hand that lets it sag.
    #[test]
    fn a_tool_that_is_taken_up_first_is_read_from_then_on() {
        let along = pressed(&pressed_twice(), 1.6);
        let mut taken = along.clone();
        taken.force_n[..30].iter_mut().for_each(|f| *f += 0.17);
        let (plain, found) = (pushes(&along), pushes(&taken));
        assert_eq!(
            found.iter().map(|p| p.puncture).collect::<Vec<_>>(),
            plain.iter().map(|p| p.puncture).collect::<Vec<_>>()
        );
        assert_eq!(found[0].samples, 30..plain[0].samples.end);
    }

    #[test]
    fn strokes_run_from_outside_to_inside() {
        let depth: Vec<f64> = (0..400).map(|i| (f64::from(i) * 0.05).sin() * 5e-3).collect();
        let found = strokes(&depth, &(0..400), 1e-3);
        assert_eq!(found.len(), 4, "{found:?}");
        assert!(found.iter().all(|s| depth[s.end - 1] > depth[s.start] + 4e-3));
        assert!(strokes(&[1.0; 50], &(0..50), 1e-3).is_empty());
    }
}
