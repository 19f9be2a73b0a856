//! Variables against which effects are plotted.

/// Variable against which the effect of a cause is plotted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// Place along the motion.
    Place,
    /// Its rate.
    Velocity,
    /// The rate of that.
    Acceleration,
    /// Force across the motion.
    Across,
    /// Measured force along the motion.
    Force,
    /// Rate of change of that force.
    ForceRate,
    /// Time.
    Time,
    /// Grip force.
    Grip,
    /// Lift force.
    Lift,
    /// Distance of the tips.
    Width,
    /// Depth of a needle beyond the surface of its sheet.
    Depth,
    /// Load at the output of a transmission.
    Load,
}

impl Variable {
    /// Its name in a sentence.
    pub fn word(self) -> &'static str {
        match self {
            Self::Place => "position",
            Self::Velocity => "speed",
            Self::Acceleration => "acceleration",
            Self::Across => "force across the motion",
            Self::Force => "force",
            Self::ForceRate => "rate of the force",
            Self::Time => "time",
            Self::Grip => "grip force",
            Self::Lift => "lift force",
            Self::Width => "width of the grip",
            Self::Depth => "depth",
            Self::Load => "load",
        }
    }
}
