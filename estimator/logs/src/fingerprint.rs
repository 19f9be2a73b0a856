//! Finds channels that repeat another trial's, wholly or in pieces, also of a trial that was not selected.
//!
//! Every window of rows has a hash. A fixed share of the hashes, chosen by their value, stands for the trial, so that a
//! piece is found wherever it lies (S. Schleimer et al., Winnowing, SIGMOD 2003).

use super::plan::Plan;
use csv::ByteRecord;
use haptics::recording::Span;
use std::collections::{BTreeMap, HashMap};

/// Rows of a window. Half as many agree by chance in channels of coarse quanta.
const WINDOW: usize = 32;
/// Every so many hashes one is kept. Twice as many miss copies of a hundred rows.
const KEPT: u64 = 8;
/// Fewest hashes that two trials share. One alone may be an accident of coarse quanta.
const LEAST: usize = 3;
/// Multiplier of the rolling hash: odd, so that no row drops out (a prime of FNV-1a).
const ROLL: u64 = 0x0000_0100_0000_01b3;

/// Hashes of one column in one trial.
#[derive(Clone, Debug)]
struct Track {
    /// The last cells, and whether each differs from the one before.
    ring: [(u64, bool); WINDOW],
    rows: usize,
    hash: u64,
    changes: usize,
    /// Hashes of windows, with the last row of each.
    kept: Vec<(u64, u32)>,
}

impl Track {
    fn new() -> Self {
        Self { ring: [(0, false); WINDOW], rows: 0, hash: 0, changes: 0, kept: Vec::new() }
    }

    fn add(&mut self, cell: u64) {
        let last = self.ring[(self.rows + WINDOW - 1) % WINDOW].0;
        let slot = &mut self.ring[self.rows % WINDOW];
        let leaves = std::mem::replace(slot, (cell, cell != last));
        self.hash = self.hash.wrapping_mul(ROLL).wrapping_add(cell);
        self.hash = self.hash.wrapping_sub(leaves.0.wrapping_mul(const { ROLL.wrapping_pow(WINDOW as u32) }));
        self.changes = self.changes + usize::from(cell != last) - usize::from(leaves.1);
        self.rows += 1;
        // A channel at rest repeats itself in every trial.
        let mixed = self.hash ^ self.hash >> 29;
        if self.rows >= WINDOW && 2 * self.changes >= WINDOW && mixed.is_multiple_of(KEPT) {
            self.kept.push((self.hash, u32::try_from(self.rows - 1).unwrap_or(u32::MAX)));
        }
    }
}

/// Hashes of the watched columns, by trial.
#[derive(Debug, Default)]
pub struct Fingerprints {
    trials: BTreeMap<Vec<u8>, Vec<Track>>,
}

/// A channel that two trials share.
#[derive(Clone, Debug, PartialEq)]
pub struct Shared {
    /// Column of the table.
    pub column: usize,
    /// The two trials, with the rows of each that the other has.
    pub trials: [(String, Vec<Span>); 2],
}

/// FNV-1a (Fowler, Noll, Vo), 64 bit.
fn fnv(mut hash: u64, bytes: &[u8]) -> u64 {
    for &byte in bytes {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    hash
}

/// Separates the parts of a trial's key.
pub const SEPARATOR: &[u8] = b" / ";

/// Keys and hashes of rows, in the order of the file, for the comparison of trials.
#[derive(Debug, Default)]
pub struct Marks {
    /// Key of the trial, and the number of rows with it.
    pub keys: Vec<(Vec<u8>, usize)>,
    /// One [`cell_hash`] a watched column and row, row after row.
    pub hashes: Vec<u64>,
}

/// Hash of one cell.
pub fn cell_hash(cell: &[u8]) -> u64 {
    fnv(1, cell)
}

impl Fingerprints {
    /// Takes one row in. Costs nothing when the file holds a single recording.
    pub fn add(&mut self, plan: &Plan, record: &ByteRecord) {
        if plan.watched.is_empty() {
            return;
        }
        let cells: Vec<&[u8]> = plan.trial_keys.iter().map(|&k| record[k].trim_ascii()).collect();
        let hashes = plan.watched.iter().map(|&c| cell_hash(&record[c])).collect();
        self.extend(plan.watched.len(), &Marks { keys: vec![(cells.join(SEPARATOR), 1)], hashes });
    }

    /// Takes the rows of `marks` in, each with `width` hashes.
    pub fn extend(&mut self, width: usize, marks: &Marks) {
        let mut hashes = marks.hashes.chunks_exact(width.max(1));
        for (key, count) in &marks.keys {
            if !self.trials.contains_key(key) {
                self.trials.insert(key.clone(), vec![Track::new(); width]);
            }
            let Some(tracks) = self.trials.get_mut(key) else { continue };
            for row in hashes.by_ref().take(*count) {
                tracks.iter_mut().zip(row).for_each(|(track, &cell)| track.add(cell));
            }
        }
    }

    /// Fingerprints of runs that were told apart after the file was read: their names, and the values of each column.
    pub fn of_runs<'a>(runs: impl Iterator<Item = (&'a str, Vec<&'a [f64]>)>) -> Self {
        let track = |values: &[f64]| {
            let mut track = Track::new();
            for value in values {
                track.add(cell_hash(&value.to_bits().to_le_bytes()));
            }
            track
        };
        let tracks = |columns: Vec<&[f64]>| columns.into_iter().map(track).collect();
        Self { trials: runs.map(|(name, columns)| (name.as_bytes().to_vec(), tracks(columns))).collect() }
    }

    /// Channels that repeat at least half of what moves in another trial's, or in their own. `watched`: their columns.
    pub fn copies(&self, watched: &[usize]) -> Vec<Shared> {
        let trials: Vec<(&Vec<u8>, &Vec<Track>)> = self.trials.iter().collect();
        let mut found = Vec::new();
        for (index, &column) in watched.iter().enumerate() {
            let kept = |trial: usize| trials[trial].1.get(index).map_or(&[][..], |track| track.kept.as_slice());
            // The first trial that has a hash stands for all.
            let mut first: HashMap<u64, (usize, u32)> = HashMap::new();
            let mut pairs: BTreeMap<(usize, usize), [Vec<u32>; 2]> = BTreeMap::new();
            for trial in 0..trials.len() {
                for &(hash, row) in kept(trial) {
                    let (other, there) = *first.entry(hash).or_insert((trial, row));
                    if other != trial {
                        let [one, two] = pairs.entry((other, trial)).or_default();
                        one.push(there);
                        two.push(row);
                    }
                }
            }
            for ((a, b), [one, two]) in pairs {
                if two.len() >= LEAST && 2 * two.len() >= kept(a).len().min(kept(b).len()) {
                    let text = |trial: usize| String::from_utf8_lossy(trials[trial].0).into_owned();
                    found.push(Shared { column, trials: [(text(a), spans(one)), (text(b), spans(two))] });
                }
            }
        }
        found
    }
}

/// Rows of the windows that end in these rows, put together where they nearly touch.
fn spans(mut ends: Vec<u32>) -> Vec<Span> {
    ends.sort_unstable();
    let mut spans: Vec<Span> = Vec::new();
    for end in ends {
        let (first, end) = ((end as usize + 1).saturating_sub(WINDOW), end as usize + 1);
        match spans.last_mut() {
            Some(last) if first <= last.end + WINDOW => last.end = end.max(last.end),
            _ => spans.push(Span { first, end }),
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fingerprints of trials with one watched column.
    fn of(trials: &[Vec<u64>]) -> Vec<Shared> {
        let mut all = Fingerprints::default();
        for (trial, cells) in trials.iter().enumerate() {
            let keys = vec![(trial.to_string().into_bytes(), cells.len())];
            all.extend(1, &Marks { keys, hashes: cells.iter().map(|cell| cell_hash(&cell.to_le_bytes())).collect() });
        }
        all.copies(&[0])
    }

    fn noise(rows: u64, seed: u64) -> Vec<u64> {
        (0..rows).map(|i| fnv(seed, &i.to_le_bytes()) % 5000).collect()
    }

    #[test]
    fn pieces_of_another_trial_are_found_wherever_they_lie() {
        let (one, two) = (noise(1000, 3), noise(800, 4));
        let pieces = [&one[600..900], &one[150..420], &noise(90, 5)[..]].concat();
        let found = of(&[one, two, pieces]);
        assert_eq!(found.len(), 1, "{found:?}");
        let [(a, here), (b, there)] = &found[0].trials;
        let rows = |spans: &[Span]| spans.iter().map(|s| s.end - s.first).sum::<usize>();
        assert!(a == "0" && b == "2" && rows(here) > 480 && rows(there) > 480, "{found:?}");
        assert!(there.iter().all(|span| span.end <= 570), "{found:?}");
    }

    #[test]
    fn rest_and_a_short_piece_are_no_copy() {
        let rest = |noisy: Vec<u64>| [vec![7; 600], noisy, vec![7; 600]].concat();
        assert_eq!(of(&[rest(noise(100, 1)), rest(noise(100, 2))]), []);
        let one = noise(1000, 3);
        assert_eq!(of(&[one.clone(), [&one[..200], &noise(500, 9)[..]].concat()]), []);
    }
}
