//! One recording: a table of samples and the facts that travel with it (`spec/logs.md`).

mod labels;
mod sidecar;

pub use labels::Labels;
pub use sidecar::{
    CLOCK_OFFSET, FOREIGN_FORCE, HandMeta, JoinedFile, Meta, OwnClock, Prior, REPAIRS, Segment, SharedChannel,
    ShiftedClock, TARE_STEP, TimeWindow, VideoMeta,
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a recording is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, JsonSchema, Serialize)]
pub struct Span {
    /// First sample.
    pub first: usize,
    /// One past the last sample.
    pub end: usize,
}

/// Something the reader should know before trusting a number.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize)]
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
    /// Entries of the sidecar that would settle the doubt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub suggested: Option<Suggested>,
}

/// Entries of a sidecar: an object as in the sidecar itself, with null for a value that only the user knows.
pub type Suggested = serde_json::Map<String, serde_json::Value>;

/// Kind of the warning that a channel was put on the clock of another.
pub const RESAMPLED: &str = "resampled";

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

    /// True if channels of several clocks were put on one.
    pub fn has_several_clocks(&self) -> bool {
        self.meta.several_clocks || self.warnings.iter().any(|warning| warning.kind == RESAMPLED)
    }

    /// Length in seconds; `None` for a clockless log.
    pub fn duration_s(&self) -> Option<f64> {
        let time = self.time_s.as_ref()?;
        Some(time.last()? - time.first()?)
    }

    /// Keeps these rows, in their order, and the spans of its warnings with them.
    pub fn keep(&mut self, rows: &[usize]) {
        if rows.len() == self.len() {
            return;
        }
        let gathered = |values: &[f64]| rows.iter().map(|&row| values[row]).collect::<Vec<f64>>();
        self.time_s = self.time_s.as_deref().map(gathered);
        for channel in &mut self.channels {
            channel.values = gathered(&channel.values);
        }
        self.labels = self.labels.as_ref().map(|labels| labels.gathered(rows.iter().copied()));
        for warning in &mut self.warnings {
            let place = |row: usize| rows.partition_point(|&kept| kept < row);
            let spans = warning.spans.iter().map(|span| Span { first: place(span.first), end: place(span.end) });
            warning.spans = spans.filter(|span| span.first < span.end).collect();
        }
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
