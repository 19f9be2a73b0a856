//! Bytes of any file, spoiled at random.

use rand::RngExt as _;
use rand::rngs::StdRng;

/// Cuts, flips, repeats, inserts or swaps bytes, once or several times.
pub fn bytes(whole: &[u8], rng: &mut StdRng) -> Vec<u8> {
    let mut spoiled = whole.to_vec();
    for _ in 0..rng.random_range(1..4) {
        if spoiled.is_empty() {
            break;
        }
        let at = rng.random_range(0..spoiled.len());
        let end = (at + rng.random_range(1..200)).min(spoiled.len());
        match rng.random_range(0..6) {
            // A program that was killed while it wrote, or a copy that ended early.
            0 => spoiled.truncate(at),
            1 => spoiled[at] ^= 1 << rng.random_range(0..8_u32),
            2 => {
                let again = spoiled[at..end].to_vec();
                spoiled.splice(at..at, again);
            }
            3 => {
                let noise: Vec<u8> = (at..end).map(|_| rng.random()).collect();
                spoiled.splice(at..at, noise);
            }
            4 => {
                spoiled.drain(at..end);
            }
            // What a disk gives back that lost a page.
            _ => spoiled[at..end].fill(0),
        }
    }
    spoiled
}
