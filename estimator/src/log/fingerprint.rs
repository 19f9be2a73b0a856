//! Finds channels that are a copy of another trial's, also of a trial that was not selected.

use super::plan::Plan;
use csv::ByteRecord;
use std::collections::BTreeMap;

/// A checkpoint is kept every so many rows.
const STRIDE: usize = 32;

/// Running hashes of one column in one trial.
#[derive(Clone, Debug)]
struct Track {
    hash: u64,
    last: u64,
    changes: usize,
    checkpoints: Vec<u64>,
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
const SEPARATOR: &[u8] = b" / ";

impl Fingerprints {
    /// Takes one row in. Costs nothing when the file holds a single recording.
    pub fn add(&mut self, plan: &Plan, record: &ByteRecord) {
        if plan.watched.is_empty() {
            return;
        }
        let cells: Vec<&[u8]> = plan.trial_keys.iter().map(|&k| record[k].trim_ascii()).collect();
        let key = cells.join(SEPARATOR);
        let fresh = || {
            (
                0,
                vec![
                    Track { hash: 0xcbf2_9ce4_8422_2325, last: 0, changes: 0, checkpoints: Vec::new() };
                    plan.watched.len()
                ],
            )
        };
        let (rows, tracks) = self.trials.entry(key).or_insert_with(fresh);
        *rows += 1;
        for (track, &column) in tracks.iter_mut().zip(&plan.watched) {
            let cell = fnv(1, &record[column]);
            track.changes += usize::from(cell != track.last);
            track.last = cell;
            track.hash = fnv(track.hash, &cell.to_le_bytes());
            if rows.is_multiple_of(STRIDE) {
                track.checkpoints.push(track.hash);
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
