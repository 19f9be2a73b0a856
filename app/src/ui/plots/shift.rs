//! Shifting an overlaid recording by its curve.

use super::choices::PlotChoices;
use super::curves::{Curve, Layer};
use egui::{Pos2, Rangef};
use egui_plot::{PlotPoint, PlotTransform};
use std::collections::BTreeMap;

/// Distance within which a curve can be grabbed, points.
const GRASP: f32 = 6.0;
/// Distance from the best-matching shift within which it snaps, points.
const SNAP: f32 = 8.0;
/// Distance that a pointer moves before it counts as a drag, points.
const DRAG: f32 = 3.0;

/// Recording that is dragged by its curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Index into the loaded recordings.
    pub recording: usize,
    /// Offset before the drag, s.
    before_s: f64,
    /// Time under the pointer at the start of the drag, s.
    grabbed_s: f64,
    /// True once the pointer has moved.
    pub moved: bool,
    /// True if the offset has snapped to the best match.
    pub snapped: bool,
    /// True if the user has undone the drag and still holds the button.
    given_up: bool,
}

/// Interaction of the pointer with a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grasp {
    /// Hovers over the overlaid recording of this index.
    Over(usize),
    /// Grabs the overlaid recording of this index at a time, s.
    Takes(usize, f64),
    /// Moves the dragged recording.
    Moves {
        /// Time under the pointer, s.
        to_s: f64,
        /// Seconds per screen point.
        s_per_point: f64,
        /// True if snapping is off.
        freely: bool,
    },
}

/// Best-matching shifts by shown and moved recording, s; `None` if the recordings are not alike.
pub type Likeliest = BTreeMap<(usize, usize), Option<f64>>;

impl PlotChoices {
    /// Applies the pointer's interaction. Returns the recording that was just grabbed.
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

    /// Moves the dragged recording back to its previous offset; the button may still be down.
    pub fn take_back(&mut self) {
        if let Some(held) = &mut self.held {
            held.given_up = true;
            let held = *held;
            self.put(held.recording, held.before_s);
        }
    }

    /// Ends the drag. Returns true if the curve was only clicked.
    pub fn let_go(&mut self) -> bool {
        self.held.take().is_some_and(|held| !held.moved && !held.given_up)
    }

    fn put(&mut self, recording: usize, offset_s: f64) {
        if let Some(entry) = self.overlaid.iter_mut().find(|o| o.recording == recording) {
            entry.offset_s = offset_s;
        }
    }
}

/// Desired shift, or the best match where it is within reach, s; true if it snapped.
fn snapped(wished_s: f64, likeliest_s: Option<f64>, reach_s: f64) -> (f64, bool) {
    match likeliest_s {
        Some(likeliest_s) if (wished_s - likeliest_s).abs() <= reach_s => (likeliest_s, true),
        _ => (wished_s, false),
    }
}

/// Index of the overlaid recording whose curve is under the pointer.
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
        // One more point on either side: their lines cross this range, too.
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

/// Distance of a point from a line segment, points; infinite where the segment is not finite.
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

    /// Offset of the recording after the move, ms.
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
