//! Names of panels.

/// A panel by the name that stands in layout files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PanelId(pub &'static str);

/// The panels that others refer to.
impl PanelId {
    /// The choice of the recording and of its fit.
    pub const RECORDING: Self = Self("recording");
    /// The recording in space.
    pub const SCENE: Self = Self("scene");
    /// Plots over one time axis.
    pub const LOG: Self = Self("log");
    /// The result of the fit.
    pub const RESULTS: Self = Self("results");
    /// States and subtasks as a list.
    pub const SEGMENTS: Self = Self("segments");
    /// The video of the hand.
    pub const VIDEO: Self = Self("video");
    /// The virtual world.
    pub const TRAINER: Self = Self("trainer");
    /// Settings and figures of the virtual world.
    pub const TRAINER_SIDE: Self = Self("trainer-side");
    /// Learning curves of a trainee.
    pub const PROGRESS: Self = Self("progress");
    /// Measured and modelled force.
    pub const DIAGNOSE: Self = Self("diagnose");
    /// The answer of the diagnosis.
    pub const DIAGNOSIS: Self = Self("diagnosis");
    /// The list of devices.
    pub const DEVICES: Self = Self("devices");
    /// One device and its timing.
    pub const DEVICE_DETAIL: Self = Self("device-detail");
}
