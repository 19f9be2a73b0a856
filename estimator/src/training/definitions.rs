//! What the measures mean: shown on demand beside every number.

/// A measure, for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Definition {
    /// Its key in JSON.
    pub key: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its unit in JSON; empty without one.
    pub unit: &'static str,
    /// How it is computed.
    pub text: &'static str,
    /// Whether less of it is better; `None` where that depends on the task.
    pub less_is_better: Option<bool>,
}

const fn less(key: &'static str, name: &'static str, unit: &'static str, text: &'static str) -> Definition {
    Definition { key, name, unit, text, less_is_better: Some(true) }
}

const fn more(key: &'static str, name: &'static str, unit: &'static str, text: &'static str) -> Definition {
    Definition { key, name, unit, text, less_is_better: Some(false) }
}

const fn neutral(key: &'static str, name: &'static str, unit: &'static str, text: &'static str) -> Definition {
    Definition { key, name, unit, text, less_is_better: None }
}

/// Every measure, those of the hand first.
pub const ALL: [Definition; 27] = [
    less("duration_s", "Time", "s", "From the first sample to the last."),
    less("moving_s", "Time in motion", "s", "Time in which the middle between the tips was faster than 5 mm/s."),
    less("path_length_m", "Path", "m", "Length of each tip's path, up to 10 Hz so that noise of sensors adds nothing."),
    neutral("range_m", "Room used", "m", "Width and height of the box that both tips stayed in."),
    less("peak_force_n", "Largest force", "N", "Largest force of a finger at any sample."),
    less(
        "rms_force_n",
        "Force",
        "N",
        "Root mean square of the larger finger's force while one pressed more than 0.05 N.",
    ),
    less("over_limit_s", "Time above the limit", "s", "Time in which a finger pressed more than the limit."),
    neutral("limit_n", "Limit", "N", "The force above which a press counts as too hard."),
    more(
        "sparc",
        "Smoothness (spectral arc length)",
        "",
        "Negative length of the speed's amplitude spectrum up to 10 Hz (amplitude threshold 0.05, padding level 4; Balasubramanian \
         et al. 2015). Nearer zero is smoother.",
    ),
    more(
        "log_dimensionless_jerk",
        "Smoothness (jerk)",
        "",
        "Minus the logarithm of duration³ / peak speed² times the integrated squared second derivative of the speed (Hogan and \
         Sternad 2009). Larger is smoother.",
    ),
    less("grasps", "Grasps", "", "How often both fingers took the block."),
    less("drops", "Drops", "", "Times a block fell more than 3 mm after it was let go, with the height."),
    less("slips", "Slips", "", "Times a pad slid more than 0.5 mm over a block that both fingers held."),
    less(
        "stacks.offset_m",
        "Offset of a stack",
        "m",
        "Middle of the upper block beside that of the lower one at the end, to the right.",
    ),
    less("stacks.tilt_rad", "Tilt of a stack", "rad", "Angle of the upper block from upright at the end."),
    less("carried_m", "Way carried", "m", "Way of the block's middle while both fingers held it."),
    neutral(
        "displaced_m",
        "Way needed",
        "m",
        "Straight way from where the block was first taken to where it was last let go.",
    ),
    less(
        "at_rest_since_s",
        "Done",
        "s",
        "Since when everything has been resting with nothing held; absent while it is not.",
    ),
    neutral("turns", "Turns", "", "Angle that the crank went through, both ways together."),
    less("reversals", "Reversals", "", "Times the crank's direction changed by more than 0.05 rad."),
    less(
        "off_tangent_j",
        "Effort off the tangent",
        "J",
        "Radial force on the handle summed along its way: effort that turns nothing.",
    ),
    less("speed_variation", "Unevenness", "", "Standard deviation of the crank's speed over its mean while it turned."),
    neutral("mean_speed_rad_s", "Speed", "rad/s", "Mean speed of the crank while it turned."),
    less(
        "punctures.overshoot_m",
        "Overshoot",
        "m",
        "How much farther the needle went in the half second after the sheet gave way.",
    ),
    less("punctures.along_m", "Lateral error", "m", "Where the sheet was pierced, from its middle."),
    less("touched", "Places touched", "", "How many places of the sheet the needle has touched."),
    less("deepest_m", "Deepest insertion", "m", "How far the point went beyond the undisturbed sheet at the most."),
];
