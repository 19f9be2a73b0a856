//! Estimates of the object in the hand: each value with its error, or not at all.

use super::contents::{Guess, guess};
use super::known::Known;
use super::slip::{Slip, slip};
use estimation::online::Report;
use estimation::online::leak::Verdict;
use foundation::estimate::Parameter;
use serde::Serialize;
use std::f64::consts::PI;

/// Properties of a thing that are seen without touching it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Look {
    /// Height of the thing, m, by eye.
    pub height_m: Option<f64>,
    /// True if it is round: as deep as wide. A thing that is not round has an unknown depth.
    pub round: bool,
    /// Mass of such a vessel when empty, kg; absent: it is no vessel.
    pub empty_kg: Option<f64>,
    /// Name of the thing, if the report cannot know it: there any carried object is a block.
    pub called: Option<&'static str>,
    /// True if it meets a thing that holds or bears it (a needle and its sheet): the force of that would pass for its
    /// weight, so no weight is told.
    pub borne: bool,
}

/// The object in the hand.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Held {
    /// Its name in reports.
    pub object: String,
    /// N.
    pub weight_n: Option<Known>,
    /// m.
    pub width_m: Option<Known>,
    /// Stiffness of one pad and the wall behind it, N/m.
    pub grip_stiffness_n_m: Option<Known>,
    /// Margin against slipping.
    pub slip: Option<Slip>,
    /// Possible contents.
    pub contents: Option<Guess>,
    /// It loses weight: kg/s.
    pub leaks_kg_s: Option<Known>,
}

/// Sizes seen by eye are right to this share.
const BY_EYE: f64 = 0.05;
/// Empty vessels of a kind differ by this share.
const EMPTY_SHARE: f64 = 0.05;
/// A share of the vessel's volume that is wall: the content is in the rest.
const INSIDE: f64 = 0.95;

impl Held {
    /// Estimates in a report of the object in the hand; `None` while nothing is held.
    pub fn of(report: &Report, look: &Look) -> Option<Self> {
        let object = report.held.clone()?;
        let known =
            |name: &str| report.parameters.iter().find(|p| p.object == object && p.name == name).and_then(known);
        let (weight_n, width_m) = (known("weight_N"), known("width_m"));
        let weight_n = weight_n.filter(|_| !look.borne);
        let leaks = report
            .leaks
            .iter()
            .find(|(name, _)| *name == object && !look.borne)
            .filter(|(_, answer)| matches!(answer.verdict, Verdict::Leak | Verdict::Both));
        Some(Self {
            weight_n,
            width_m,
            grip_stiffness_n_m: known("grip_stiffness_N_m"),
            slip: known("friction_lower_bound").zip(report.slip_margin).and_then(|(held, margin)| {
                // The margin is the remaining part of the ratio that surely held.
                slip((1.0 - margin) * held.value, held)
            }),
            contents: known("mass_kg").zip(width_m).and_then(|(mass, width)| contents(mass, width, look)),
            leaks_kg_s: leaks.and_then(|_| known("leak_kg_s")),
            object: look.called.map_or(object.clone(), str::to_owned),
        })
    }

    /// True when nothing is known of it yet.
    pub fn is_blank(&self) -> bool {
        self.weight_n.is_none() && self.width_m.is_none() && self.slip.is_none()
    }
}

fn known(parameter: &Parameter) -> Option<Known> {
    let value = parameter.value.filter(|_| parameter.identified)?;
    Some(Known { value, std_error: parameter.std_error.filter(|e| e.is_finite())? })
}

/// Density of the content of a round vessel, and its possible kinds.
fn contents(mass_kg: Known, width_m: Known, look: &Look) -> Option<Guess> {
    let (height_m, empty_kg) = (look.height_m.filter(|_| look.round)?, look.empty_kg?);
    let volume_m3 = INSIDE * 0.25 * PI * width_m.value.powi(2) * height_m;
    if volume_m3 <= 0.0 {
        return None;
    }
    let inside_kg = mass_kg.value - empty_kg;
    let mass_error = mass_kg.std_error.hypot(EMPTY_SHARE * empty_kg);
    let size_error = (2.0 * width_m.std_error / width_m.value).hypot(BY_EYE);
    let value = inside_kg / volume_m3;
    Some(guess(Known { value, std_error: (mass_error / volume_m3).hypot(value * size_error) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(mass_kg: f64) -> Report {
        let object = "barrel".to_owned();
        let parameters = vec![
            Parameter::identified(&object, "mass_kg", mass_kg, 0.0005, 100, "weighed"),
            Parameter::identified(&object, "weight_N", 9.81 * mass_kg, 0.005, 100, "weighed"),
            Parameter::identified(&object, "width_m", 0.036, 1e-4, 100, "felt"),
            Parameter::unidentified(&object, "grip_stiffness_N_m", 100, "too even"),
        ];
        Report { held: Some(object), parameters, slip_margin: Some(0.4), ..Report::default() }
    }

    #[test]
    fn only_what_is_known_is_told() {
        let look = Look { height_m: Some(0.046), round: true, empty_kg: Some(0.060), ..Look::default() };
        let full = Held::of(&report(0.060 + 0.0445), &look).expect("held");
        assert!(full.weight_n.is_some() && full.grip_stiffness_n_m.is_none() && full.leaks_kg_s.is_none());
        let guess = full.contents.expect("a density");
        assert_eq!(guess.kinds[0].0, "water or something like it", "{guess:?}");
        let empty = Held::of(&report(0.0605), &look).and_then(|h| h.contents).expect("a density");
        assert_eq!(empty.kinds[0].0, "nothing or a gas", "{empty:?}");
        assert_eq!(Held::of(&report(0.1), &Look::default()).and_then(|h| h.contents), None, "no volume, no density");
        assert_eq!(Held::of(&Report::default(), &look), None);
    }

    #[test]
    fn what_is_borne_by_a_sheet_has_its_name_and_no_weight() {
        let look = Look { called: Some("needle"), borne: true, ..Look::default() };
        let held = Held::of(&report(0.150), &look).expect("held");
        assert_eq!(held.object, "needle");
        assert!(held.weight_n.is_none() && held.leaks_kg_s.is_none() && held.width_m.is_some());
    }
}
