//! Preview of a long log, to be drawn while the rest is still being read.
//!
//! Readers hand in every column as it grows; it is kept as a pyramid of bands only. Names and order are those of the
//! file. Values are in the units that the reader has (SI if the format or the header says so): a picture to look at,
//! not a recording to fit.

use super::pyramid::{Band, Pyramid};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Largest number of columns that are previewed: more curves are unreadable.
const MOST_TRACKS: usize = 64;

/// Grows in the reader's thread, is looked at from another one.
#[derive(Debug, Default)]
pub struct Preview {
    groups: Mutex<Vec<Tracks>>,
}

/// Columns that share a clock.
#[derive(Debug, Default)]
struct Tracks {
    name: String,
    /// Time in s, or nothing when rows are counted instead.
    time: Pyramid,
    columns: Vec<(String, Pyramid)>,
}

/// One curve of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Column of the file; with its topic in front where there are several.
    pub name: String,
    /// Samples read so far.
    pub samples: usize,
    /// True when `at` counts rows, because no column holds the time.
    pub by_row: bool,
    /// Middle of each block of samples (s, or rows) and the band of its values.
    pub points: Vec<(f64, Band)>,
}

impl Preview {
    /// Takes in new values: `columns` are (name, all or the newest values), whose first value is sample `first`;
    /// `time_s` likewise, empty without a clock. `group` tells clocks apart.
    pub fn grow<'a>(
        &self,
        group: &str,
        first: usize,
        time_s: &[f64],
        columns: impl IntoIterator<Item = (&'a str, &'a [f64])>,
    ) {
        let mut groups = self.lock();
        let at = groups.iter().position(|g| g.name == group).unwrap_or_else(|| {
            groups.push(Tracks { name: group.to_owned(), ..Tracks::default() });
            groups.len() - 1
        });
        let tracks = &mut groups[at];
        append(&mut tracks.time, first, time_s);
        for (name, values) in columns {
            let known = tracks.columns.iter().position(|(n, _)| n == name);
            let at = match known {
                Some(at) => at,
                None if tracks.columns.len() == MOST_TRACKS => continue,
                None => {
                    tracks.columns.push((name.to_owned(), Pyramid::default()));
                    tracks.columns.len() - 1
                }
            };
            append(&mut tracks.columns[at].1, first, values);
        }
    }

    /// The picture of the rows so far, in at most `pieces` points a curve.
    pub fn curves(&self, pieces: usize) -> Vec<Curve> {
        let groups = self.lock();
        let several = groups.len() > 1;
        let mut curves = Vec::new();
        for group in groups.iter() {
            for (name, values) in &group.columns {
                let name = if several { format!("{} {name}", group.name) } else { name.clone() };
                curves.push(group.curve(name, values, pieces));
            }
        }
        curves
    }

    /// True before the first row.
    pub fn is_empty(&self) -> bool {
        self.lock().iter().all(|g| g.columns.iter().all(|(_, values)| values.is_empty()))
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Tracks>> {
        self.groups.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The part of `values` (whose first is sample `first`) that the pyramid does not have yet.
fn append(pyramid: &mut Pyramid, first: usize, values: &[f64]) {
    if let Some(new) = pyramid.len().checked_sub(first).and_then(|known| values.get(known..)) {
        pyramid.extend(new);
    }
}

impl Tracks {
    fn curve(&self, name: String, values: &Pyramid, pieces: usize) -> Curve {
        let by_row = self.time.is_empty();
        let samples = values.len();
        let piece = values.granule(samples.div_ceil(pieces.max(1)));
        let points = (0..samples.div_ceil(piece))
            .filter_map(|k| {
                let range = k * piece..((k + 1) * piece).min(samples);
                let band = values.whole(range.clone()).filter(|b| b.low <= b.high)?;
                let rows = 0.5 * (range.start + range.end) as f64;
                let at = if by_row { rows } else { self.time.whole(range).map(|t| 0.5 * (t.low + t.high))? };
                Some((at, band))
            })
            .collect();
        Curve { name, samples, by_row, points }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_follow_what_has_been_read() {
        let preview = Preview::default();
        assert!(preview.is_empty() && preview.curves(100).is_empty());
        let time: Vec<f64> = (0..100_000).map(|i| f64::from(i) * 1e-3).collect();
        let wave: Vec<f64> = time.iter().map(|t| (0.3 * t).sin()).collect();
        for end in [7, 5_000, 60_123, 100_000] {
            // All rows so far, or only the newest: known values are passed over.
            let first = if end == 60_123 { 4_000 } else { 0 };
            preview.grow("", first, &time[first..end], [("wave", &wave[first..end])]);
            let curves = preview.curves(500);
            let curve = &curves[0];
            assert_eq!((curve.samples, curve.name.as_str(), curve.by_row), (end, "wave", false));
            assert!(curve.points.len() <= 500 && (end < 5000 || curve.points.len() > 100), "{}", curve.points.len());
            for (at, band) in &curve.points {
                let value = (0.3 * at).sin();
                assert!(band.low - 1e-9 <= value && value <= band.high + 0.02, "{at} {band:?}");
                assert!(band.high - band.low < 0.2);
            }
            let last = curve.points.last().expect("a point").0;
            assert!((last - time[end - 1]).abs() < 0.5, "{last}");
        }
    }

    #[test]
    fn rows_stand_for_a_missing_clock_and_topics_for_several() {
        let preview = Preview::default();
        preview.grow("/a", 0, &[], [("x", &[1.0, f64::NAN, 3.0][..])]);
        preview.grow("/b", 0, &[0.0, 1.0], [("x", &[5.0, 6.0][..]), ("y", &[f64::NAN, f64::NAN][..])]);
        let curves = preview.curves(10);
        let names: Vec<&str> = curves.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["/a x", "/b x", "/b y"]);
        assert!(curves[0].by_row && curves[2].points.is_empty());
    }
}
