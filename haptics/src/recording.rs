//! One recording: a table of samples and the facts that travel with it (`spec/logs.md`).

mod labels;

pub use labels::Labels;

use crate::hand::Hand;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a recording is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Task {
    /// Two blocks, unstacked and restacked.
    BlockStack,
    /// A crank turned by its handle.
    Crank,
    /// A needle through a membrane.
    Needle,
    /// A mechanism with one degree of freedom.
    Mechanism,
    /// A heavy object of unknown contents.
    Barrel,
    /// A toggle switch.
    Switch,
    /// The load that hangs on a force/torque sensor, in several orientations.
    Payload,
}

impl Task {
    /// Every task.
    pub const ALL: [Self; 7] =
        [Self::BlockStack, Self::Crank, Self::Needle, Self::Mechanism, Self::Barrel, Self::Switch, Self::Payload];

    /// The task of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|task| task.name() == name)
    }

    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::BlockStack => "block-stack",
            Self::Crank => "crank",
            Self::Needle => "needle",
            Self::Mechanism => "mechanism",
            Self::Barrel => "barrel",
            Self::Switch => "switch",
            Self::Payload => "payload",
        }
    }
}

/// Axes of the wrench columns of a force/torque sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WrenchFrame {
    /// The sensor's own axes: they turn with it.
    Sensor,
    /// The axes in which the orientation is given.
    Base,
}

impl WrenchFrame {
    /// The other one.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Sensor => Self::Base,
            Self::Base => Self::Sensor,
        }
    }

    /// The name used in sidecars and in names of columns.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sensor => "sensor",
            Self::Base => "base",
        }
    }
}

/// Geometry of the hand that made the recording.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Meta {
    /// Task that was performed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<Task>,
    /// Sampling rate where the table has no time column, Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// Gravity, m/s²; 9.81 when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_m_s2: Option<f64>,
    /// The axis that points up: `y` (default), `-y`, `z`, … or `none` for a horizontal plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<String>,
    /// Axes of wrench columns whose names do not state them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wrench_frame: Option<WrenchFrame>,
    /// Payload and bias that were removed from the wrench, named `object.name` as in a fit.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub compensated: BTreeMap<String, f64>,
    /// Hand geometry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hand: Option<HandMeta>,
    /// The program's column name → the file's.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub columns: BTreeMap<String, String>,
    /// Factor a column is multiplied by (after its unit is converted).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub scale: BTreeMap<String, f64>,
    /// Keep only rows whose column (program's or file's name) has this value.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub select: BTreeMap<String, serde_json::Value>,
    /// +1 or −1 per column.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sign: BTreeMap<String, f64>,
    /// Parameters that are known and not to be estimated.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub known: BTreeMap<String, f64>,
    /// Prior of a parameter before the recording. Names are those of a fit (`weight_N`), or with the object in front
    /// (`block-2.weight_N`).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub prior: BTreeMap<String, Prior>,
    /// Least and largest value that a parameter can have, named as in `prior`; `null` leaves a side open.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub bounds: BTreeMap<String, [Option<f64>; 2]>,
    /// States set by a person, with their times: in the place of the result of a segmentation.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub segments: Vec<Segment>,
    /// The video that was taken meanwhile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video: Option<VideoMeta>,
    /// Keys this version does not know: kept, so that saving loses nothing.
    #[serde(flatten)]
    pub other: BTreeMap<String, serde_json::Value>,
}

/// A video of the hand.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VideoMeta {
    /// The file, from the log's folder.
    pub file: std::path::PathBuf,
    /// Time of the recording at which its first picture was taken, s.
    #[serde(default)]
    pub begins_at_s: f64,
}

/// Segment of a recording in one state, set by a person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prior {
    /// Most likely value.
    pub mean: f64,
    /// Standard deviation, above zero.
    pub std: f64,
}

impl Meta {
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

/// One column of samples in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The program's name for it: `<quantity>[finger]_<unit>`, e.g. `fx1_N`.
    pub name: String,
    /// SI unit as in column names, e.g. `N`, `m_s`; empty when the quantity has none.
    pub unit: String,
    /// One value a sample.
    pub values: Vec<f64>,
}

/// Samples `first..end` of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Span {
    /// First sample.
    pub first: usize,
    /// One past the last sample.
    pub end: usize,
}

/// Something the reader should know before trusting a number.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Warning {
    /// Stable short name: `gap`, `stuck-channel`, `copied-channel`, `saturation`, `clock-jump`, `no-clock`, …
    pub kind: String,
    /// The column it is about, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// Where, in samples.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spans: Vec<Span>,
    /// One sentence: what, where, what to do.
    pub text: String,
}

/// One recording: equal-length channels, in SI units, with its sidecar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Origin of the recording (file, and trial if the file holds several).
    pub name: String,
    /// Value of the `trial` column when the file holds several.
    pub trial: Option<String>,
    /// Sample times, s, strictly increasing; `None` when the log is clockless.
    pub time_s: Option<Vec<f64>>,
    /// All numeric columns but the time.
    pub channels: Vec<Channel>,
    /// State label of each sample, by a person or a generator: only ever used to score.
    pub labels: Option<Labels>,
    /// The sidecar.
    pub meta: Meta,
    /// Found while loading.
    pub warnings: Vec<Warning>,
}

impl Recording {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time_s.as_ref().map_or_else(|| self.channels.first().map_or(0, |c| c.values.len()), Vec::len)
    }

    /// True when there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The samples of a channel by its name.
    pub fn channel(&self, name: &str) -> Option<&[f64]> {
        self.channels.iter().find(|c| c.name == name).map(|c| c.values.as_slice())
    }

    /// Median sampling rate, Hz; `None` for a clockless log or a single sample.
    pub fn rate_hz(&self) -> Option<f64> {
        let time = self.time_s.as_ref()?;
        let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
        if steps.is_empty() {
            return None;
        }
        let middle = steps.len() / 2;
        let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
        Some(1.0 / *median)
    }

    /// Length in seconds; `None` for a clockless log.
    pub fn duration_s(&self) -> Option<f64> {
        let time = self.time_s.as_ref()?;
        Some(time.last()? - time.first()?)
    }

    /// The samples `span` as a recording of their own (labels and time too; warnings stay behind).
    pub fn slice(&self, span: Span) -> Self {
        let range = span.first..span.end;
        Self {
            name: self.name.clone(),
            trial: self.trial.clone(),
            time_s: self.time_s.as_ref().map(|t| t[range.clone()].to_vec()),
            channels: self
                .channels
                .iter()
                .map(|c| Channel { values: c.values[range.clone()].to_vec(), ..c.clone() })
                .collect(),
            labels: self.labels.as_ref().map(|l| l.slice(range)),
            meta: self.meta.clone(),
            warnings: Vec::new(),
        }
    }
}
