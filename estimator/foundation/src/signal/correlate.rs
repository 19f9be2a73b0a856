//! Sliding weighted sums.

/// Outputs that are summed side by side: independent sums keep the processor's pipelines full, and each is still added up in order.
const LANES: usize = 16;

/// `sum over k of weights[k] · values[i + k]` for every i that has all of its samples: as many sums as the window fits in places.
///
/// Degenerate: no weights, or more of them than values, give nothing.
pub fn correlate(values: &[f64], weights: &[f64]) -> Vec<f64> {
    let window = weights.len();
    if window == 0 || window > values.len() {
        return Vec::new();
    }
    let mut sums = vec![0.0; values.len() - window + 1];
    let (blocks, rest) = sums.as_chunks_mut::<LANES>();
    let done = blocks.len() * LANES;
    for (block, at) in blocks.iter_mut().zip((0..).step_by(LANES)) {
        for (weight, from) in weights.iter().zip(at..) {
            for (sum, value) in block.iter_mut().zip(&values[from..from + LANES]) {
                *sum += weight * value;
            }
        }
    }
    for (sum, at) in rest.iter_mut().zip(done..) {
        *sum = weights.iter().zip(&values[at..at + window]).map(|(w, v)| w * v).sum();
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_sum_is_its_definition_to_the_bit(
            values in proptest::collection::vec(-1e3..1e3_f64, 0..200),
            weights in proptest::collection::vec(-2.0..2.0_f64, 0..40),
        ) {
            let found = correlate(&values, &weights);
            let expected: Vec<f64> = if weights.is_empty() {
                Vec::new()
            } else {
                values.windows(weights.len()).map(|w| w.iter().zip(&weights).fold(0.0, |s, (v, w)| s + w * v)).collect()
            };
            prop_assert_eq!(found, expected);
        }
    }
}
