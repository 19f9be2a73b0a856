//! Constraints as a fit tells them: these types are part of the JSON of `touchstone fit --json`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The kind of a geometric constraint. `screw` and `undecided` stand beside the kinds of the contract: nothing is called one of those on
/// weak grounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ConstraintKind {
    /// Turning about a fixed axis.
    Revolute,
    /// Sliding along a fixed line.
    Prismatic,
    /// No constraint.
    Free,
    /// A membrane: stiffness depends on the deepest insertion.
    Membrane,
    /// A surface that pushes one way only.
    Unilateral,
    /// A path that is neither a line nor a circle.
    Spline,
    /// Turning about an axis and sliding along it in proportion.
    Screw,
    /// The recording cannot tell.
    Undecided,
}

/// A constraint found in a recording.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Constraint {
    /// What it is.
    pub kind: ConstraintKind,
    /// Trial or recording it was found in, when there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recording: Option<String>,
    /// What it holds, where a recording has several objects: `block-1`, …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub object: Option<String>,
    /// Centre of rotation, m; two numbers for a planar recording, three otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_m: Option<Vec<f64>>,
    /// Centre by the thesis's own method, normals over twelve samples, m; for comparison.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normals_center_m: Option<Vec<f64>>,
    /// Radius, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// 95 % interval of the radius, m; the upper end is absent when the path could as well be straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_interval_m: Option<(f64, Option<f64>)>,
    /// Unit vector: of the axis (revolute), of the motion (prismatic).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Vec<f64>>,
    /// Stiffer than the manipulator and its sensors can tell: `true`, `false` where it gives way, `null` where the recording cannot tell (no
    /// force, a constant one, or too little of it).
    #[serde(default)]
    pub rigid: Option<bool>,
    /// Standard errors by name: `center_m` (one number, the larger axis), `radius_m`, `direction_rad`; empty where nothing was measured.
    #[serde(default)]
    pub std_error: BTreeMap<String, f64>,
    /// Angle turned (revolute), rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coverage_rad: Option<f64>,
    /// Path length covered, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coverage_m: Option<f64>,
    /// Root mean square distance of the path from the constraint, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_m: Option<f64>,
    /// Mean constraint force along the outward normal, N, where forces were recorded (thesis, eq. 5.1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub constraint_force_n: Option<f64>,
    /// Stiffness against the force across the motion, where the constraint gives way measurably or a bound can be given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yielding: Option<Yielding>,
    /// Whether force across the motion shows that there is a constraint at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub existence: Option<Existence>,
    /// Whether it was seen to hold both ways.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sided: Option<Sided>,
    /// Sudden shifts of the path, as when the grasp slips.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub slips: Vec<Slip>,
    /// Root mean square distance of a path in space from its own plane, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane_residual_m: Option<f64>,
    /// The motion that the constraint allows, as a screw.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub screw: Option<Screw>,
    /// The path written compactly, where it is neither line nor circle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guide: Option<Guide>,
    /// Where the surface is and how it rubs, for one that pushes one way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<Touched>,
    /// What happened when, for a membrane.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub phases: Vec<StrokePhase>,
    /// The likelier kind when none is certain, for who must name one: no promise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaning: Option<Leaning>,
    /// One sentence: what shows it, or what is missing.
    pub evidence: String,
}

/// A kind that is likelier than the others but not certain.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Leaning {
    /// What it would be.
    pub kind: ConstraintKind,
    /// Its probability against the one that fits next best, even odds before; absent where none can be given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub probability: Option<f64>,
}

impl Constraint {
    /// Nothing known yet.
    pub fn blank(recording: Option<String>, evidence: &str) -> Self {
        Self {
            kind: ConstraintKind::Undecided,
            recording,
            object: None,
            center_m: None,
            normals_center_m: None,
            radius_m: None,
            radius_interval_m: None,
            direction: None,
            rigid: None,
            std_error: BTreeMap::new(),
            coverage_rad: None,
            coverage_m: None,
            residual_m: None,
            constraint_force_n: None,
            yielding: None,
            existence: None,
            sided: None,
            slips: Vec::new(),
            plane_residual_m: None,
            screw: None,
            guide: None,
            surface: None,
            phases: Vec::new(),
            leaning: None,
            evidence: evidence.to_owned(),
        }
    }
}

/// Whether force that weight, inertia and friction do not explain shows a constraint (`docs/constraints.md`).
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Existence {
    /// `true` when it shows one, `false` when it shows that there is none worth speaking of, absent when it cannot tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exists: Option<bool>,
    /// Probability of unexplained force as large as this without a constraint.
    pub p_value: f64,
    /// Share of free motions that are called constrained by mistake, at most.
    pub false_alarm_rate: f64,
    /// Mean unexplained force, N: along the outward normal of the path, or against the motion.
    pub unexplained_n: f64,
    /// Its standard error, N.
    pub std_error_n: f64,
    /// Root mean square of the unexplained force, smoothed over independent pieces, N.
    pub unexplained_rms_n: f64,
    /// Constraint force that would have been seen nineteen times of twenty, N.
    pub detectable_n: f64,
    /// Independent samples that the force amounts to.
    pub effective_samples: f64,
    /// `normal` or `tangential`: the direction in which force was tested.
    pub direction: String,
}

/// From which side a constraint was loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
pub enum Sided {
    /// Loaded one way only: that it holds the other way was not seen.
    #[serde(rename = "one-sided seen")]
    OneSided,
    /// Loaded significantly both ways.
    #[serde(rename = "two-sided")]
    TwoSided,
}

/// How the path gives way to force across it.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Yielding {
    /// Stiffness, N/m; absent when no give was seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_n_m: Option<f64>,
    /// 95 % interval, N/m; the upper end is absent when it may be rigid.
    pub interval_n_m: (f64, Option<f64>),
    /// Stiffness of hand and pads that it was measured with, N/m: what is as stiff counts as rigid.
    pub manipulator_n_m: f64,
}

/// A sudden shift of the path, as when the grasp slips on a handle.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Slip {
    /// By when, s; absent without a clock.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// Not before, s: a slip while nothing moves only shows in the motion after it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_before_s: Option<f64>,
    /// Sample at which it happened.
    pub sample: usize,
    /// Shift of the path (of the centre, for a crank), m.
    pub displacement_m: Vec<f64>,
    /// Its size in standard errors.
    pub significance: f64,
}

/// A motion of one degree of freedom: a turn about an axis with a shift along it.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Screw {
    /// A point of the axis, m; the origin for a slide, which has none.
    pub point_m: [f64; 3],
    /// Unit vector of the axis.
    pub axis: [f64; 3],
    /// Shift a radian, m/rad: 0 is a hinge; absent means infinite, a slide.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch_m_rad: Option<f64>,
    /// Standard error of the pitch, m/rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch_std_error: Option<f64>,
}

/// A path as a uniform cubic B-spline with few control points (as `guide` in a world file; `docs/constraints.md`).
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Guide {
    /// Control points, m; two numbers each for a planar path, three otherwise. An open path ends in its first and last.
    pub points_m: Vec<Vec<f64>>,
    /// The last leads back to the first.
    pub closed: bool,
    /// Length, m.
    pub length_m: f64,
    /// Root mean square distance of the recorded path from it, m.
    pub rms_m: f64,
    /// Largest one, m.
    pub largest_m: f64,
}

/// A surface that pushes one way, where no push presses it in.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Touched {
    /// A point of it in the middle of what was touched, m.
    pub point_m: Vec<f64>,
    /// Unit vector out of it.
    pub normal: Vec<f64>,
    /// Standard error of the point along the normal, m.
    pub offset_std_error_m: f64,
    /// Standard error of the normal's direction, rad.
    pub tilt_std_error_rad: f64,
    /// Friction coefficient, where something slid on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Its standard error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_std_error: Option<f64>,
    /// One end of what was touched, m.
    pub touched_from_m: Vec<f64>,
    /// The other end, m.
    pub touched_to_m: Vec<f64>,
}

/// What a needle is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// Outside.
    Free,
    /// Pressing the sheet in.
    Insertion,
    /// Through the sheet, going in.
    Penetration,
    /// On the way out.
    Extraction,
}

/// One phase of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct StrokePhase {
    /// What.
    pub phase: Phase,
    /// From, s (sample numbers without a clock).
    pub t0: f64,
    /// To, s.
    pub t1: f64,
    /// Force over depth: mean stiffness, N/m (thesis, figure 5.14); absent in free motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_n_m: Option<f64>,
    /// Deepest place, m beyond the surface.
    pub deepest_m: f64,
}
