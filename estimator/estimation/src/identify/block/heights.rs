//! Heights of blocks and shear of the pads, from the places where blocks were picked up and put down: one regression
//! over all of it.
//!
//! While a carried block rests on a tower, the height of the grip is
//!
//! `y = G + Σ heights below + s load + c ((m + 1) load − Σ weights × level)`
//!
//! with `G` the height of the grasp over the block's foot (one a carry), the load the lift less the block's weight, `s`
//! the give of both pads in shear, `c` the give of one contact between blocks or floor and m blocks below. The load
//! presses every contact under it, and the blocks below press those under them. The thesis took differences of mean
//! heights, whose gives differ.
//!
//! Several recordings of the same blocks share heights and gives; grasps are each one's own. A stack that was
//! rearranged in one recording and left alone in another is then known in both.

use super::height_slip_correction::{HeightSlip, height_slips};
use super::rests::{Rest, rests};
use super::signals::{Blocks, object};
use crate::identify::limits::{LEAST_OF_PARABOLA, SIGNIFICANT};
use crate::regression::bootstrap::{Resampled, block_bootstrap_within};
use crate::regression::linear::{LinearFit, least_squares};
use foundation::estimate::{EstimateError, Parameter};
use std::ops::Range;

/// Relative difference of the give of the floor's contact from that between blocks, one standard deviation. They cannot
/// be told apart, because the floor's give looks like the pads' shear.
/// Choice: no case of the ablation reads it.
const CONTACTS_DIFFER: f64 = 0.33;
/// Prior standard deviation of the give of a contact, m/N.
/// Derived: 1/(5 kN/m), the give of a soft block.
const GIVE_BEFORE: f64 = 2e-4;

/// The regression's rows and columns.
struct Rows {
    columns: Vec<Vec<f64>>,
    height: Vec<f64>,
    /// Change of the height for a floor contact that yields 1 m/N more than the others.
    floor: Vec<f64>,
    /// Error of the height by the slips that were taken out, m.
    slipped: Vec<f64>,
    /// Rows of each rest.
    stretches: Vec<Range<usize>>,
}

/// One recording of the blocks.
pub(super) struct Stacked<'a> {
    blocks: &'a Blocks<'a>,
    weights_n: &'a [f64],
    rests: Vec<Rest>,
    slips: Vec<HeightSlip>,
}

impl<'a> Stacked<'a> {
    pub(super) fn new(blocks: &'a Blocks<'a>, weights_n: &'a [f64]) -> Self {
        let rests = rests(blocks, weights_n.len().min(blocks.count()));
        let slips = height_slips(blocks, &rests);
        Self { blocks, weights_n, rests, slips }
    }

    /// Warnings about the corrected slips.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> {
        self.slips.iter().map(|slip| slip.told(&self.blocks.recording.name, &self.rests[slip.rest]))
    }
}

/// Columns of the regression: grasp heights of every recording's carries, block heights, shear give, contact give.
struct Columns {
    /// First grasp of each recording.
    grasps: Vec<usize>,
    /// First block.
    blocks: usize,
    shear: usize,
    contact: usize,
}

impl Columns {
    fn of(seen: &[Stacked<'_>], count: usize) -> Self {
        let mut blocks = 0;
        let grasps = seen
            .iter()
            .map(|one| {
                let first = blocks;
                blocks += one.rests.len() / 2;
                first
            })
            .collect();
        Self { grasps, blocks, shear: blocks + count, contact: blocks + count + 1 }
    }
}

/// Heights of all blocks, and the stiffness of one pad in shear, out of one or several recordings.
pub(super) fn heights(seen: &[Stacked<'_>]) -> Result<Vec<Parameter>, EstimateError> {
    let count = seen.iter().map(|one| one.weights_n.len()).max().unwrap_or(0);
    let at = Columns::of(seen, count);
    let rows = rows(seen, &at);
    let rests = || seen.iter().flat_map(|one| &one.rests);
    let mut parameters = Vec::new();
    let shown = |rest: &Rest| rest.samples.len() >= LEAST_OF_PARABOLA;
    if !rests().any(shown) || rows.height.len() <= rows.columns.len() {
        let why = "no block was held still on the ground";
        parameters.extend((1..=count).map(|n| Parameter::unidentified(&object(n), "height_m", 0, why)));
        parameters.push(Parameter::unidentified("pad", "shear_stiffness_N_m", 0, why));
        return Ok(parameters);
    }
    let (fit, resampled) = with_prior(&rows, at.contact)?;
    let resampled = |column: usize| resampled.as_ref().map(|r| r[column]);
    let give = fit.values[at.contact];
    // Change of the fit for a floor that yields differently from the blocks.
    let shift: Vec<f64> = rows.floor.iter().map(|f| f * CONTACTS_DIFFER * give).collect();
    let floor = least_squares(&rows.columns, &shift, None)?;
    let slipped = least_squares(&rows.columns, &rows.slipped, None)?;
    for number in 1..=count {
        let column = at.blocks + number - 1;
        let below = rests().filter(|r| r.below.contains(&(number - 1))).map(|r| r.samples.len()).sum::<usize>();
        let samples = rests().map(|r| r.samples.len()).sum::<usize>();
        if below < LEAST_OF_PARABOLA || !fit.identified[column] {
            let why =
                "it was never clearly below a block that was carried to or from a known height; unstack and restack it";
            parameters.push(Parameter::unidentified(&object(number), "height_m", below, why));
            continue;
        }
        let resolution_m = seen.iter().map(|one| one.blocks.resolution_m).fold(0.0, f64::max);
        let systematic = floor.values[column].hypot(tilt(seen, number - 1)).hypot(resolution_m);
        let systematic = systematic.hypot(slipped.values[column]);
        let error = fit.std_errors[column].hypot(systematic);
        let drawn = resampled(column).map(|r| r.hypot(systematic));
        let how = format!(
            "grip heights while blocks rest on it and elsewhere, the give of pads and contacts ({:.0} µm/N) taken out; how flat \
             the faces are is not in the error",
            give * 1e6
        );
        let found = Parameter::identified(&object(number), "height_m", fit.values[column], error, samples, &how);
        parameters.push(found.with_bootstrap(drawn));
    }
    parameters.push(shear_stiffness(&fit, &floor, at.shear, rows.height.len(), resampled(at.shear)));
    Ok(parameters)
}

/// Stiffness of one pad in shear: two side by side carry the load.
fn shear_stiffness(
    fit: &LinearFit,
    floor: &LinearFit,
    column: usize,
    samples: usize,
    resampled: Option<f64>,
) -> Parameter {
    let (give, error) = (2.0 * fit.values[column], 2.0 * fit.std_errors[column].hypot(floor.values[column]));
    if fit.identified[column] && give > SIGNIFICANT * error {
        let how = "give of the grip under load over a block at rest, the contacts' own give taken out; one pad";
        let drawn = resampled.map(|r| 2.0 * r.hypot(floor.values[column]) / (give * give));
        return Parameter::identified("pad", "shear_stiffness_N_m", 1.0 / give, error / (give * give), samples, how)
            .with_bootstrap(drawn);
    }
    let why = "the lift varied too little while a block rested";
    Parameter::unidentified("pad", "shear_stiffness_N_m", samples, why)
}

fn rows(seen: &[Stacked<'_>], at: &Columns) -> Rows {
    let columns = vec![Vec::new(); at.contact + 1];
    let mut rows = Rows { columns, height: Vec::new(), floor: Vec::new(), slipped: Vec::new(), stretches: Vec::new() };
    for (Stacked { blocks, weights_n, rests, slips }, grasp) in seen.iter().zip(&at.grasps) {
        for (number, rest) in rests.iter().enumerate().filter(|(_, r)| r.samples.len() >= LEAST_OF_PARABOLA) {
            let slip = slips.iter().find(|slip| slip.rest == number);
            let standing: f64 = rest.below.iter().map(|j| weights_n[*j]).sum();
            let pressed: f64 = rest.below.iter().enumerate().map(|(level, j)| weights_n[*j] * (level + 1) as f64).sum();
            let first = rows.height.len();
            for i in blocks.rows(&rest.samples) {
                let load = blocks.lift[i] - weights_n[rest.carry];
                rows.columns.iter_mut().for_each(|column| column.push(0.0));
                let mut set = |column: usize, value: f64| rows.columns[column][rows.height.len()] = value;
                set(grasp + rest.carry, 1.0);
                rest.below.iter().for_each(|k| set(at.blocks + k, 1.0));
                set(at.shear, load);
                set(at.contact, (rest.below.len() + 1) as f64 * load - pressed);
                rows.floor.push(load - standing);
                let (correction, error) = slip.map_or((0.0, 0.0), |s| s.correction_m(blocks.signals.time_s[i]));
                rows.height.push(blocks.height[i] + correction);
                rows.slipped.push(error);
            }
            rows.stretches.push(first..rows.height.len());
        }
    }
    rows
}

/// The regression with a prior of a contact: one more row pulls its parameter to zero, as strongly as [`GIVE_BEFORE`]
/// weighs against the noise of the rows. Its errors by resampling within each rest come with it.
fn with_prior(rows: &Rows, contact: usize) -> Result<(LinearFit, Option<Resampled>), EstimateError> {
    let alone = least_squares(&rows.columns, &rows.height, None)?;
    let mut columns = rows.columns.clone();
    for (j, column) in columns.iter_mut().enumerate() {
        column.push(if j == contact { alone.rms / GIVE_BEFORE } else { 0.0 });
    }
    let mut height = rows.height.clone();
    height.push(0.0);
    let mut fit = least_squares(&columns, &height, None)?;
    let mut stretches = rows.stretches.clone();
    stretches.push(rows.height.len()..height.len());
    let resampled = block_bootstrap_within(&columns, &height, None, &fit, &stretches);
    if fit.values[contact] < 0.0 {
        // Nothing grows under a load: the nearest possible value is a contact that does not yield. Its other possible
        // values are in the errors, which stay.
        columns[contact][..rows.height.len()].fill(0.0);
        fit.values = least_squares(&columns, &height, None)?.values;
        fit.values[contact] = 0.0;
    }
    Ok((fit, resampled))
}

/// Error by blocks that turn between the pads, m. A slip of one finger alone moves the grip's middle by half of it, one
/// way or the other. It is the largest of the carries that show this height in a recording, in the mean of the
/// recordings.
fn tilt(seen: &[Stacked<'_>], block: usize) -> f64 {
    let shows = |pair: &[Rest]| pair.iter().any(|r| r.below.contains(&block));
    let even = 3.0_f64.sqrt();
    let largest = |one: &Stacked<'_>| {
        let pairs = one.rests.chunks(2).filter(|pair| shows(pair) && pair.iter().all(|r| !r.samples.is_empty()));
        pairs
            .map(|pair| one.blocks.finger_disagreement(&pair[0].samples, &pair[1].samples) / even)
            .max_by(f64::total_cmp)
    };
    let all: Vec<f64> = seen.iter().filter_map(largest).collect();
    // They turned this way in one and that way in another.
    all.iter().fold(0.0, |sum: f64, tilt| sum.hypot(*tilt)) / all.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block picked up from a tower of one and put down on the floor; the pads yield 0.3 mm/N in shear, and contacts
    /// `contact_m_n`.
    fn rows_of(contact_m_n: f64) -> (Rows, usize) {
        let (mut columns, mut height) = (vec![Vec::new(); 4], Vec::new());
        for (below, from_n, to_n) in [(1.0, -0.3, 0.0), (0.0, 0.0, -0.7)] {
            for k in 0..200 {
                let load = from_n + (to_n - from_n) * f64::from(k) / 199.0;
                let row = [1.0, below, load, (below + 1.0) * load];
                columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
                let noise_m = 5e-6 * (f64::from(k) * 2.399).sin();
                height.push(0.008 + 0.016 * below + 3e-4 * load + contact_m_n * row[3] + noise_m);
            }
        }
        let zeros = vec![0.0; height.len()];
        let stretches = vec![0..200, 200..400];
        (Rows { columns, height, floor: zeros.clone(), slipped: zeros, stretches }, 3)
    }

    #[test]
    fn a_contact_gives_or_is_hard_but_never_grows_under_a_load() {
        let (rows, contact) = rows_of(5e-5);
        let (fit, _) = with_prior(&rows, contact).expect("a fit");
        assert!((fit.values[contact] - 5e-5).abs() < 5e-6, "{:?}", fit.values);
        let (rows, contact) = rows_of(-5e-5);
        let (fit, _) = with_prior(&rows, contact).expect("a fit");
        assert_eq!(fit.values[contact], 0.0);
        // Values that the rows allow without it: the shear takes over their common part.
        assert!(fit.values[2] > 2e-4 && fit.values[2] < 3e-4, "{:?}", fit.values);
        assert!(fit.std_errors[contact] > 0.0);
    }
}
