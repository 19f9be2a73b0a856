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
