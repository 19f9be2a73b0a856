//! Residual table: RMS of every channel in every state, beside the noise.

use crate::diagnose::contract::Residual;
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::tasks::SystemState;

/// Residuals of a comparison in each state. `state`: channel and state of a row; `None` for a row of no channel.
pub fn residuals(
    study: &ChannelFit,
    (unit, floor): (&str, f64),
    state: &dyn Fn(usize) -> Option<(&'static str, SystemState)>,
) -> Vec<Residual> {
    let (before, after) = (study.residual(&[]), study.residual(&study.picks()));
    let mut found: Vec<((&str, SystemState), [f64; 2], usize)> = Vec::new();
    for i in 0..study.y.len() {
        let Some(state) = state(i) else { continue };
        let k = found.iter().position(|(s, ..)| *s == state).unwrap_or_else(|| {
            found.push((state, [0.0; 2], 0));
            found.len() - 1
        });
        let (_, squares, rows) = &mut found[k];
        squares[0] += (study.layout.weight[i] * before[i]).powi(2);
        squares[1] += (study.layout.weight[i] * after[i]).powi(2);
        *rows += 1;
    }
    let one = |((channel, state), squares, rows): ((&str, SystemState), [f64; 2], usize)| {
        let [rms_before, rms_after] = squares.map(|s| (s / rows as f64).sqrt());
        let noise_floor = Some(floor).filter(|floor| *floor > 0.0);
        let (channel, unit) = (channel.to_owned(), unit.to_owned());
        Residual { channel, unit, state, rows, rms_before, rms_after, noise_floor }
    };
    found.into_iter().map(one).collect()
}
