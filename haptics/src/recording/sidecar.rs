//! The sidecar: facts about a recording that its table does not hold. `docs/use/own-logs.md` is made from these types.

use super::{Task, WrenchFrame};
use crate::hand::Hand;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};
use serde_json::json;
use std::collections::BTreeMap;

/// Writes null for the empty text that stands for a name without a column.
fn with_null<S: Serializer>(columns: &BTreeMap<String, String>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(columns.iter().map(|(name, source)| (name, Some(source).filter(|text| !text.is_empty()))))
}

/// Geometry of the hand that made the recording.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct HandMeta {
    /// Link length, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link_m: Option<f64>,
    /// Base of the only finger, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base_m: Option<[f64; 2]>,
    /// Base of the left finger, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base1_m: Option<[f64; 2]>,
    /// Base of the right finger, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base2_m: Option<[f64; 2]>,
}

/// The sidecar `<stem>.meta.json`. Every key is optional.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Meta {
    /// Task that was performed: one of the program's, or the name of one of yours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<String>", extend("x-absent" = "told by the columns"), example = &"crank")]
    pub task: Option<Task>,
    /// Sampling rate of a table without a time column, Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "the time column"), example = 1000.0)]
    pub rate_hz: Option<f64>,
    /// Gravity, m/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "9.81"), example = 9.80665)]
    pub gravity_m_s2: Option<f64>,
    /// Axis that points up: `x`, `y`, `z`, the same with a minus, or `none` for a horizontal plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "y"), example = &"z")]
    pub up: Option<String>,
    /// Axes of wrench columns whose names do not state them: `sensor` or `base`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "sensor"), example = &"base")]
    pub wrench_frame: Option<WrenchFrame>,
    /// Load and bias that were removed from the wrench, named as in a fit; written by `convert --compensate`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "nothing was removed"), example = json!({ "payload.weight_N": 10.8 }))]
    pub compensated: BTreeMap<String, f64>,
    /// Geometry of the hand, for joint angles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "the hand of the program"), example = json!({ "link_m": 0.08, "base1_m": [-0.04, 0.0], "base2_m": [0.04, 0.0] }))]
    pub hand: Option<HandMeta>,
    /// The file's column for each name of the program; null for a name that the file does not have.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", serialize_with = "with_null")]
    #[schemars(with = "BTreeMap<String, Option<String>>", extend("x-absent" = "known names are read"), example = json!({ "q_m": "Extension [mm]", "t_s": null }))]
    pub columns: BTreeMap<String, String>,
    /// Column of the times of a channel that has a clock of its own, such as pairs of time and value side by side.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "one clock for all"), example = json!({ "f_N": "time_force_s" }))]
    pub clocks: BTreeMap<String, OwnClock>,
    /// True if the columns had clocks of their own before they were put on the one of the table; written by `convert`.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    #[schemars(extend("x-absent" = "false"), example = true)]
    pub several_clocks: bool,
    /// Other files of the same run, whose channels are put on the log's clock.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-absent" = "one file"), example = json!([{ "file": "force.csv", "offset_s": 0.012 }]))]
    pub join: Vec<JoinedFile>,
    /// Factor of a column, in place of the conversion of its unit. Behind a unit of the log format (`_mm`) it is a further factor.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "1"), example = json!({ "f_N": 35.15 }))]
    pub scale: BTreeMap<String, f64>,
    /// Rows to read: a column of the program or the file, and the value or list of values that it must have.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "all rows"), example = json!({ "mechanism": "drawer", "trial": [1, 2] }))]
    pub select: BTreeMap<String, serde_json::Value>,
    /// Time from which the recording is read, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "the start"), example = 2.0)]
    pub from_s: Option<f64>,
    /// Time up to which the recording is read, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "the end"), example = 8.0)]
    pub to_s: Option<f64>,
    /// Several windows of time; each is a recording. They take the place of `from_s` and `to_s`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-absent" = "all of it"), example = json!([{ "from_s": 2.0, "to_s": 4.0 }, { "from_s": 6.0 }]))]
    pub windows: Vec<TimeWindow>,
    /// Sign of a column: 1 or −1.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "1"), example = json!({ "fx1_N": -1.0 }))]
    pub sign: BTreeMap<String, f64>,
    /// Texts of cells without a measurement. Rows with one of them are left out as rows with an empty cell are.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-absent" = "such a cell is refused"), example = json!(["NaN", "OVLD"]))]
    pub missing: Vec<String>,
    /// Kinds of repairs that are not made: `sentinels`, `burst-stamps`, `held-samples`, `wrapped-angle`,
    /// `wrapped-counter`, `stuck-channel`, `spikes`, `tare-step`, `foreign-force`, `clock-offset`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-absent" = "all repairs"), example = json!(["spikes"]))]
    pub as_recorded: Vec<String>,
    /// Parameters that are known and not estimated.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "nothing is known"), example = json!({ "mass_kg": 0.107 }))]
    pub known: BTreeMap<String, f64>,
    /// Normal prior of a parameter: `weight_N`, or `block-2.weight_N` with the object in front.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "no prior"), example = json!({ "weight_N": { "mean": 0.5, "std": 0.1 } }))]
    pub prior: BTreeMap<String, Prior>,
    /// Least and largest value of a parameter, named as in `prior`; null leaves a side open.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-absent" = "no bounds"), example = json!({ "friction_mu": [0.0, null] }))]
    pub bounds: BTreeMap<String, [Option<f64>; 2]>,
    /// States that a person set, with their times; they take the place of the segmentation.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-absent" = "the segmentation's"), example = json!([{ "t0": 0.0, "t1": 1.5, "state": "free-motion" }]))]
    pub segments: Vec<Segment>,
    /// Video of the recording.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-absent" = "none"), example = json!({ "file": "hand.mp4", "begins_at_s": -0.4 }))]
    pub video: Option<VideoMeta>,
    /// Keys this version does not know: kept, so that saving loses nothing.
    #[serde(flatten)]
    pub other: BTreeMap<String, serde_json::Value>,
}

/// A window of time, in the times of the recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeWindow {
    /// First time, s; the start of the recording when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    /// Last time, s; the end of the recording when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_s: Option<f64>,
}

/// The clock of a column that does not belong to the clock of the log.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum OwnClock {
    /// The column that holds its times.
    Column(String),
    /// A column of times that start apart from those of the log.
    Shifted(ShiftedClock),
}

/// A column of times that start apart from those of the log.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShiftedClock {
    /// The column that holds the times.
    pub column: String,
    /// Seconds that are added to them.
    pub offset_s: f64,
}

impl OwnClock {
    /// The same with another name of its column.
    #[must_use]
    pub fn renamed(self, name: &dyn Fn(&String) -> String) -> Self {
        match self {
            Self::Column(column) => Self::Column(name(&column)),
            Self::Shifted(shifted) => Self::Shifted(ShiftedClock { column: name(&shifted.column), ..shifted }),
        }
    }

    /// The column, and the seconds that are added to its times.
    pub fn parts(&self) -> (&str, f64) {
        match self {
            Self::Column(column) => (column, 0.0),
            Self::Shifted(shifted) => (&shifted.column, shifted.offset_s),
        }
    }
}

/// Another file of the same run.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JoinedFile {
    /// The file, from the log's folder; it may have a sidecar of its own.
    pub file: std::path::PathBuf,
    /// Seconds that are added to the file's times; estimated when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset_s: Option<f64>,
    /// Channel of both files that shows the offset, or two names: the log's and the file's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<SharedChannel>,
}

/// A channel that two files share.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SharedChannel {
    /// Its name in both.
    Same(String),
    /// Its name in the log, and in the other file.
    Pair([String; 2]),
}

impl SharedChannel {
    /// Its name in the log, and in the other file.
    pub fn names(&self) -> (&str, &str) {
        match self {
            Self::Same(name) => (name, name),
            Self::Pair([own, other]) => (own, other),
        }
    }
}

/// A video of the hand.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct VideoMeta {
    /// The file, from the log's folder.
    pub file: std::path::PathBuf,
    /// Time of the recording at which its first picture was taken, s.
    #[serde(default)]
    pub begins_at_s: f64,
}

/// Segment of a recording in one state, set by a person.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Segment {
    /// Start, s (sample number when the log is clockless).
    pub t0: f64,
    /// End, s.
    pub t1: f64,
    /// Name of the state, e.g. `hold-above-ground`.
    pub state: String,
    /// The subtask that it belongs to, e.g. `carry-block-1`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub subtask: Option<String>,
}

/// A normal distribution, in the parameter's unit.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Prior {
    /// Most likely value.
    pub mean: f64,
    /// Standard deviation, above zero.
    pub std: f64,
}

/// Kinds of repairs, by their names in `as_recorded`: those on loading, and those of a fit.
pub const REPAIRS: [&str; 10] = [
    "sentinels",
    "burst-stamps",
    "held-samples",
    "wrapped-angle",
    "wrapped-counter",
    "stuck-channel",
    "spikes",
    TARE_STEP,
    FOREIGN_FORCE,
    CLOCK_OFFSET,
];
/// The repair of a step in the zero of a force sensor.
pub const TARE_STEP: &str = "tare-step";
/// The repair of a stretch of time in which the force does not belong to the motion.
pub const FOREIGN_FORCE: &str = "foreign-force";
/// The repair of a lag between channels with clocks of their own.
pub const CLOCK_OFFSET: &str = "clock-offset";

impl Meta {
    /// True unless the repairs of this kind are switched off.
    pub fn repairs(&self, kind: &str) -> bool {
        !self.as_recorded.iter().any(|listed| listed == kind)
    }

    /// The windows of time that are used; none when all of the recording is.
    pub fn windows(&self) -> Vec<TimeWindow> {
        if self.from_s.is_none() && self.to_s.is_none() {
            return self.windows.clone();
        }
        vec![TimeWindow { from_s: self.from_s, to_s: self.to_s }]
    }

    /// Gravity, m/s².
    pub fn gravity(&self) -> f64 {
        self.gravity_m_s2.unwrap_or(9.81)
    }

    /// The hand that made the recording: the default one, with the sidecar's statements put in.
    pub fn hand(&self) -> Hand {
        let default = Hand::default();
        let Some(meta) = &self.hand else { return default };
        let base = |given: Option<[f64; 2]>, index: usize| {
            given.map_or(default.fingers[index].base_m, |[x, y]| crate::Vec2::new(x, y))
        };
        let link_m = meta.link_m.unwrap_or(default.fingers[0].link_m);
        Hand::new(link_m, base(meta.base1_m.or(meta.base_m), 0), base(meta.base2_m, 1))
    }
}
