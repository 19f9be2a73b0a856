//! Rests of carried blocks in the grip: where they were picked up and put down, and what lay below.

use super::signals::{Blocks, MAIN};

/// Least height of a block above another one, as a share of its size, by the grip's place.
/// Choice: no case of the ablation reads it.
const LEAST_STEP: f64 = 0.15;

/// One end of a carry: where the block rested in the grip.
pub struct Rest {
    /// Carry, from 0.
    pub carry: usize,
    /// Samples of this end.
    pub samples: Vec<usize>,
    /// Carries of the blocks below, from the floor up.
    pub below: Vec<usize>,
}

/// Place of a block, by the middle of the grip.
#[derive(Clone, Copy)]
struct Place {
    x_m: f64,
    y_m: f64,
}

/// Both ends of every carry, with the tower that the block stood on.
pub fn rests(blocks: &Blocks<'_>, count: usize) -> Vec<Rest> {
    // Before and after it was carried.
    let rested = |k: usize| blocks.task.showing_around("height_m", MAIN, k + 1).map(|names| blocks.samples(&names));
    let place = |samples: &[usize]| {
        let n = samples.len() as f64;
        (!samples.is_empty()).then(|| Place {
            x_m: samples.iter().map(|i| blocks.signals.position[*i].x).sum::<f64>() / n,
            y_m: samples.iter().map(|i| blocks.height[*i]).sum::<f64>() / n,
        })
    };
    let width = |k: usize| {
        let carried = blocks.shown(MAIN, k + 1);
        carried.iter().map(|i| blocks.width[*i]).sum::<f64>() / carried.len().max(1) as f64
    };
    let least_step_m = LEAST_STEP * blocks.signals.object_m();
    let widths: Vec<f64> = (0..count).map(width).collect();
    let picks: Vec<Option<Place>> = (0..count).map(|k| place(&rested(k)[0])).collect();
    let places: Vec<Option<Place>> = (0..count).map(|k| place(&rested(k)[1])).collect();
    let below = |k: usize, here: Option<Place>| -> Vec<usize> {
        let Some(here) = here else { return Vec::new() };
        // Blocks carried before lie where they were put, the others where they will be taken from.
        let now = |j: usize| if j < k { places[j] } else { picks[j] };
        let mut tower: Vec<(f64, usize)> = (0..count)
            .filter(|j| *j != k)
            .filter_map(|j| now(j).map(|at| (at, j)))
            .filter(|(at, j)| (at.x_m - here.x_m).abs() < 0.5 * (widths[*j] + widths[k]))
            .filter(|(at, _)| at.y_m < here.y_m - least_step_m)
            .map(|(at, j)| (at.y_m, j))
            .collect();
        tower.sort_by(|a, b| a.0.total_cmp(&b.0));
        tower.into_iter().map(|(_, j)| j).collect()
    };
    (0..count)
        .flat_map(|k| {
            let [pick, put] = rested(k);
            let (at_pick, at_place) = (below(k, picks[k]), below(k, places[k]));
            [Rest { carry: k, samples: pick, below: at_pick }, Rest { carry: k, samples: put, below: at_place }]
        })
        .collect()
}
