//! The single most probable path of states.

use super::Chain;

/// The most probable path, and the logarithm of its probability density together with the sequence; a tie goes to the state with
/// the lower number. `log_emissions` as in [`super::forward_backward`].
pub fn viterbi(chain: &Chain, log_emissions: &[f64]) -> (Vec<u8>, f64) {
    let k = chain.states();
    let samples = log_emissions.len() / k;
    if samples == 0 {
        return (Vec::new(), 0.0);
    }
    // By target: the sources of one target lie together.
    let log: Vec<f64> = (0..k * k).map(|i| chain.transition()[(i % k) * k + i / k].ln()).collect();
    let mut best: Vec<f64> = (0..k).map(|s| chain.start()[s].ln() + log_emissions[s]).collect();
    let mut next = vec![0.0; k];
    let mut came_from = vec![0_u8; samples * k];
    for (row, from) in log_emissions.chunks_exact(k).zip(came_from.chunks_exact_mut(k)).skip(1) {
        for to in 0..k {
            let (mut top, mut source) = (f64::NEG_INFINITY, 0);
            for (state, (value, link)) in best.iter().zip(&log[to * k..(to + 1) * k]).enumerate() {
                let candidate = value + link;
                if candidate > top {
                    (top, source) = (candidate, state);
                }
            }
            next[to] = top + row[to];
            from[to] = source as u8;
        }
        std::mem::swap(&mut best, &mut next);
    }
    let mut state = (0..k).reduce(|a, b| if best[b] > best[a] { b } else { a }).unwrap_or(0);
    let log_probability = best[state];
    let mut path = vec![0; samples];
    for t in (0..samples).rev() {
        path[t] = state as u8;
        state = usize::from(came_from[t * k + state]);
    }
    (path, log_probability)
}

/// Logarithm of the probability density of a given path together with the sequence; −∞ for a path that is not allowed.
pub fn path_log_probability(chain: &Chain, log_emissions: &[f64], path: &[u8]) -> f64 {
    let k = chain.states();
    let mut total = 0.0;
    let mut before = None;
    for (row, state) in log_emissions.chunks_exact(k).zip(path.iter().map(|s| usize::from(*s))) {
        let link = before.map_or(chain.start()[state], |from: usize| chain.transition()[from * k + state]);
        total += link.ln() + row[state];
        before = Some(state);
    }
    total
}
