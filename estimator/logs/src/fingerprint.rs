//! Finds channels that are a copy of another trial's, also of a trial that was not selected.

use super::plan::Plan;
use csv::ByteRecord;
use std::collections::BTreeMap;

/// Number of rows from one checkpoint to the next.
const STRIDE: usize = 32;

/// Running hashes of one column in one trial.
#[derive(Clone, Debug)]
struct Track {
    hash: u64,
    last: u64,
    changes: usize,
    checkpoints: Vec<u64>,
}

impl Track {
    fn new() -> Self {
        Self { hash: 0xcbf2_9ce4_8422_2325, last: 0, changes: 0, checkpoints: Vec::new() }
    }

    fn add(&mut self, cell: u64, checked: bool) {
        self.changes += usize::from(cell != self.last);
        self.last = cell;
        self.hash = fnv(self.hash, &cell.to_le_bytes());
        if checked {
            self.checkpoints.push(self.hash);
        }
    }
}

/// Running hashes of the watched columns, by trial.
#[derive(Debug, Default)]
pub struct Fingerprints {
    trials: BTreeMap<Vec<u8>, (usize, Vec<Track>)>,
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
                self.trials.insert(key.clone(), (0, vec![Track::new(); width]));
            }
            let Some((rows, tracks)) = self.trials.get_mut(key) else { continue };
            for row in hashes.by_ref().take(*count) {
                *rows += 1;
                let checked = rows.is_multiple_of(STRIDE);
                tracks.iter_mut().zip(row).for_each(|(track, &cell)| track.add(cell, checked));
            }
        }
    }

    /// Pairs (watched column, trial, the trial it equals, rows compared): equal over at least half of the shorter one, with
    /// content that moves.
    pub fn copies(&self) -> Vec<(usize, String, String, usize)> {
        let mut found = Vec::new();
        let text = |key: &[u8]| String::from_utf8_lossy(key).into_owned();
        let trials: Vec<_> = self.trials.iter().collect();
        let columns = trials.first().map_or(0, |(_, (_, tracks))| tracks.len());
        for column in 0..columns {
            // First checkpoint → trials that share it: only those can be copies of each other.
            let mut buckets: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
            for (i, (_, (_, tracks))) in trials.iter().enumerate() {
                if let Some(&first) = tracks[column].checkpoints.first() {
                    buckets.entry(first).or_default().push(i);
                }
            }
            for members in buckets.values().filter(|m| m.len() > 1) {
                for (&a, &b) in members.iter().zip(&members[1..]) {
                    let (one, two) = (&trials[a].1.1[column], &trials[b].1.1[column]);
                    let shared = one.checkpoints.iter().zip(&two.checkpoints).take_while(|(x, y)| x == y).count();
                    let shorter = one.checkpoints.len().min(two.checkpoints.len());
                    let moves = one.changes.min(two.changes) >= STRIDE / 2;
                    if 2 * shared >= shorter && moves {
                        found.push((column, text(trials[a].0), text(trials[b].0), shared * STRIDE));
                    }
                }
            }
        }
        found
    }
}
