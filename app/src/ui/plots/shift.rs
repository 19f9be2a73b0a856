//! Shifting a recording that lies over the shown one by its curve.

use super::choices::PlotChoices;
use super::curves::{Curve, Layer};
use egui::{Pos2, Rangef};
use egui_plot::{PlotPoint, PlotTransform};
use std::collections::BTreeMap;

/// Points within which a curve can be taken hold of.
const GRASP: f32 = 6.0;
/// Points from the likeliest shift within which it is taken.
const SNAP: f32 = 8.0;
/// Points that a pointer moves before it counts as a drag.
const DRAG: f32 = 3.0;

/// A recording that is held by its curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Which of the loaded ones.
    pub recording: usize,
    /// Its shift before, s.
    before_s: f64,
    /// The time under the pointer when it was taken hold of, s.
    grabbed_s: f64,
    /// The pointer has moved.
    pub moved: bool,
    /// It lies where it is most like the shown one.
    pub snapped: bool,
    /// The user has taken it back and still holds the button.
    given_up: bool,
}

/// What the pointer does with a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grasp {
    /// It is over one, by its place among those laid over.
    Over(usize),
    /// It takes hold of one, at a time.
    Takes(usize, f64),
    /// It moves what is held.
    Moves {
        /// To this time, s.
        to_s: f64,
        /// A point is so many seconds.
        s_per_point: f64,
        /// Nothing attracts it.
        freely: bool,
    },
}

/// Shifts at which recordings are most like each other, by shown and moved recording; `None`: they are not alike.
pub type Likeliest = BTreeMap<(usize, usize), Option<f64>>;

impl PlotChoices {
    /// Does what the pointer asks for; the recording that was just taken hold of.
    pub fn grasp(&mut self, grasp: Grasp, current: usize, clockless: bool) -> Option<usize> {
        match grasp {
            Grasp::Over(_) => None,
            Grasp::Takes(place, grabbed_s) => {
                let entry = self.overlaid.get(place)?;
                let (recording, before_s) = (entry.recording, entry.offset_s);
                let held = Held { recording, before_s, grabbed_s, moved: false, snapped: false, given_up: false };
                self.held = Some(held);
                Some(recording)
            }
            Grasp::Moves { to_s, s_per_point, freely } => {
                let held = self.held.as_mut().filter(|h| !h.given_up)?;
                held.moved |= (to_s - held.grabbed_s).abs() > f64::from(DRAG) * s_per_point;
                if held.moved {
                    let wished_s = held.before_s + to_s - held.grabbed_s;
                    let likeliest_s = self.likeliest.get(&(current, held.recording)).copied().flatten();
                    let attracted = likeliest_s.filter(|_| !freely);
                    let (offset_s, snapped) = snapped(wished_s, attracted, f64::from(SNAP) * s_per_point);
                    held.snapped = snapped;
                    let held = *held;
                    self.put(held.recording, if clockless { offset_s.round() } else { offset_s });
                }
                None
            }
        }
    }

    /// What is held goes back to where it was; the button may still be down.
    pub fn take_back(&mut self) {
        if let Some(held) = &mut self.held {
            held.given_up = true;
            let held = *held;
            self.put(held.recording, held.before_s);
        }
    }

    /// The button was let go: true where the curve was only clicked on.
    pub fn let_go(&mut self) -> bool {
        self.held.take().is_some_and(|held| !held.moved && !held.given_up)
    }

    fn put(&mut self, recording: usize, offset_s: f64) {
        if let Some(entry) = self.overlaid.iter_mut().find(|o| o.recording == recording) {
            entry.offset_s = offset_s;
        }
    }
}

/// A wished shift, or the likeliest where that is near enough.
fn snapped(wished_s: f64, likeliest_s: Option<f64>, reach_s: f64) -> (f64, bool) {
    match likeliest_s {
        Some(likeliest_s) if (wished_s - likeliest_s).abs() <= reach_s => (likeliest_s, true),
        _ => (wished_s, false),
    }
}

/// The place of the other recording whose curve lies under the pointer.
pub fn under<'a>(
    curves: impl Iterator<Item = (&'a Curve, &'a [PlotPoint])>,
    transform: &PlotTransform,
    pointer: Pos2,
) -> Option<usize> {
    let at = |point: &PlotPoint| transform.position_from_point(point);
    let time = |x: f32| transform.value_from_position(Pos2::new(x, pointer.y)).x;
    let near = Rangef::new(pointer.x, pointer.x).expand(GRASP);
    let mut best: Option<(f32, usize)> = None;
    for (curve, points) in curves {
        let Layer::Other(place) = curve.layer else { continue };
        // One point more on either side: lines between them pass here, too.
        let first = points.partition_point(|p| p.x < time(near.min)).saturating_sub(1);
        let end = (points.partition_point(|p| p.x <= time(near.max)) + 1).min(points.len());
        for pair in points.get(first..end).unwrap_or_default().windows(2) {
            let distance = to_line(pointer, at(&pair[0]), at(&pair[1]));
            if distance <= GRASP && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, place));
            }
        }
    }
    best.map(|(_, place)| place)
}

/// From a point to a piece of a line, points; without end where the piece has none.
fn to_line(point: Pos2, from: Pos2, to: Pos2) -> f32 {
    let along = to - from;
    let share = if along.length_sq() > 0.0 { (point - from).dot(along) / along.length_sq() } else { 0.0 };
    let distance = (point - (from + share.clamp(0.0, 1.0) * along)).length();
    if distance.is_finite() { distance } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::super::choices::Overlaid;
    use super::*;
    use egui::pos2;

    fn held_at(likeliest_s: Option<f64>) -> PlotChoices {
        let overlaid = vec![Overlaid { recording: 1, offset_s: 0.5 }];
        let mut choices = PlotChoices { overlaid, ..PlotChoices::default() };
        choices.likeliest.insert((0, 1), likeliest_s);
        assert_eq!(choices.grasp(Grasp::Takes(0, 2.0), 0, false), Some(1));
        choices
    }

    /// Where the recording then lies, ms.
    fn moved(choices: &mut PlotChoices, to_s: f64, freely: bool) -> f64 {
        choices.grasp(Grasp::Moves { to_s, s_per_point: 0.01, freely }, 0, false);
        (1e3 * choices.overlaid[0].offset_s).round()
    }

    #[test]
    fn what_is_held_follows_the_pointer_and_comes_to_rest_where_it_is_likeliest() {
        let mut choices = held_at(Some(0.9));
        assert_eq!(moved(&mut choices, 2.01, false), 500.0, "no drag yet");
        assert_eq!(moved(&mut choices, 2.2, false), 700.0);
        assert_eq!(moved(&mut choices, 2.45, false), 900.0, "0.95 is near enough");
        assert!(choices.held.is_some_and(|h| h.snapped));
        assert_eq!(moved(&mut choices, 2.45, true), 950.0, "but not against the will");
        assert_eq!(moved(&mut choices, 2.6, false), 1_100.0);
        assert!(!choices.let_go() && choices.held.is_none());
        assert_eq!(moved(&mut held_at(None), 2.4, false), 900.0, "nothing is known to attract it");
    }

    #[test]
    fn what_was_taken_back_stays_until_the_button_is_let_go() {
        let mut choices = held_at(None);
        moved(&mut choices, 3.0, false);
        choices.take_back();
        assert_eq!(choices.overlaid[0].offset_s, 0.5);
        assert_eq!(moved(&mut choices, 3.5, false), 500.0);
        assert!(!choices.let_go());
        assert!(held_at(None).let_go(), "a click is no drag");
    }

    #[test]
    fn distances_are_to_the_piece_and_not_to_its_line() {
        let (a, b) = (pos2(0.0, 0.0), pos2(10.0, 0.0));
        assert_eq!(to_line(pos2(5.0, 3.0), a, b), 3.0);
        assert_eq!(to_line(pos2(13.0, 4.0), a, b), 5.0);
        assert_eq!(to_line(pos2(3.0, 4.0), a, a), 5.0);
        assert_eq!(to_line(pos2(0.0, 0.0), a, pos2(f32::NAN, 0.0)), f32::INFINITY);
    }
}
