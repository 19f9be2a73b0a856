//! Few samples that stand for many.

/// Most samples that stand for all: quantiles of a million samples are not needed to the last digit.
pub const MOST: usize = 8192;

/// Indices of samples that stand for all `n`, increasing: one out of each equal block, not always at the same place in
/// it. A periodic signal is therefore not always met in the same phase.
pub fn thinned(n: usize) -> impl Iterator<Item = usize> {
    let count = n.min(MOST);
    (0..count).map(move |k| {
        let (first, end) = (k * n / count, (k + 1) * n / count);
        first + (k * 7919) % (end - first).max(1)
    })
}
