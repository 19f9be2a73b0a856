//! The fit of one recording of blocks: every parameter of every block that was carried.

use super::heights::{Stacked, heights};
use super::leak::leak;
use super::signals::{Blocks, MAIN, object};
use super::weight::weight_and_mass;
use crate::segment::{Method, Segmentation};
use foundation::estimate::{EstimateError, Fit, Parameter};
use foundation::tasks::{SystemState, Thresholds};
use haptics::recording::{Recording, Task};

/// Fits the blocks of one recording, with `thresholds` or those chosen from its noise. The segmentation that was used comes
/// with the fit.
pub fn fit(recording: &Recording, thresholds: Option<Thresholds>) -> Result<(Fit, Segmentation), EstimateError> {
    fit_by(Method::Threshold, recording, thresholds)
}

/// [`fit`] with the states of either method.
pub fn fit_by(
    method: Method,
    recording: &Recording,
    thresholds: Option<Thresholds>,
) -> Result<(Fit, Segmentation), EstimateError> {
    let blocks = Blocks::of(method, recording, thresholds)?;
    let fit = describe(&blocks)?;
    Ok((fit, blocks.segmentation))
}

/// Reason why there is nothing to fit, and the remedy.
fn nothing(blocks: &Blocks<'_>) -> EstimateError {
    let name = &blocks.recording.name;
    let slides = blocks.segmentation.states.iter().any(|s| s.state == SystemState::SlidingOnGround);
    EstimateError::Other(if slides {
        format!(
            "the block in {name} is slid and never lifted, so what it weighs does not show in what the fingers feel: lift it once to fit it; a \
             diagnosis tells what resists it on the table"
        )
    } else {
        format!(
            "no block was carried in {name}: there is nothing to fit; check the task and the signs of the forces, and that a state of the \
             task with a subtask shows {MAIN}"
        )
    })
}

/// All that one recording shows.
pub(super) fn describe(blocks: &Blocks<'_>) -> Result<Fit, EstimateError> {
    let (count, recording) = (blocks.count(), blocks.recording);
    if count == 0 {
        return Err(nothing(blocks));
    }
    let mut parameters = Vec::new();
    let mut weights_n = Vec::new();
    let mut correlated = Vec::new();
    let mut warnings = blocks.segmentation.warnings.clone();
    let pad = blocks.pad_stiffness(count);
    for number in 1..=count {
        let weight = blocks.weight(number)?;
        correlated.extend(weight_and_mass(&weight[0], &weight[1]));
        weights_n.push(weight[0].value.unwrap_or(0.0));
        parameters.extend(weight);
        parameters.push(blocks.width(number, &pad)?);
    }
    if let Some(why) = blocks.unshown("height_m") {
        parameters.extend((1..=count).map(|n| Parameter::unidentified(&object(n), "height_m", 0, &why)));
    } else {
        let stacked = [Stacked::new(blocks, &weights_n)];
        warnings.extend(stacked[0].warnings());
        parameters.extend(heights(&stacked)?);
    }
    parameters.push(pad);
    let masses_kg: Vec<f64> = weights_n.iter().map(|w| w / recording.meta.gravity()).collect();
    for number in 1..=count {
        parameters.extend(blocks.friction(number));
        parameters.extend(leak(blocks, number, count, &masses_kg));
    }
    // Read by object: all of block 1, all of block 2, then the pads.
    parameters.sort_by(|a, b| a.object.cmp(&b.object));
    Ok(Fit {
        task: Task::BlockStack.name().to_owned(),
        parameters,
        constraints: (1..=count).filter_map(|number| blocks.constraint(number)).collect(),
        correlated,
        warnings,
        ..Fit::default()
    })
}
