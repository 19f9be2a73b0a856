//! Definitions of the measures: shown on demand beside every number.

/// A measure, for people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Definition {
    /// Its key in JSON.
    pub key: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its unit in JSON; empty without one.
    pub unit: &'static str,
    /// Method of its computation.
    pub text: &'static str,
    /// True if less of it is better; `None` if that depends on the task.
    pub less_is_better: Option<bool>,
    /// A difference that does not matter, in its unit: smaller spreads of experts count as this much.
    pub grain: f64,
    /// Advice for improvement, in the imperative, without a full stop; empty if nothing can be said in general.
    pub advice: &'static str,
}

impl Definition {
    /// The definition of a key.
    pub fn of(key: &str) -> Option<&'static Self> {
        ALL.iter().find(|definition| definition.key == key)
    }
}

const fn less(key: &'static str, name: &'static str, unit: &'static str, text: &'static str) -> Definition {
    Definition { key, name, unit, text, less_is_better: Some(true), grain: 0.0, advice: "" }
}

const fn more(key: &'static str, name: &'static str, unit: &'static str, text: &'static str) -> Definition {
    Definition { less_is_better: Some(false), ..less(key, name, unit, text) }
}

const fn neutral(key: &'static str, name: &'static str, unit: &'static str, text: &'static str) -> Definition {
    Definition { less_is_better: None, ..less(key, name, unit, text) }
}

impl Definition {
    const fn grain(self, grain: f64, advice: &'static str) -> Self {
        Self { grain, advice, ..self }
    }
}

/// Every measure, those of the hand first.
pub const ALL: [Definition; 33] = [
    less(
        "completed_s",
        "Time to complete",
        "s",
        "From the hand's first motion (5 mm/s) until the last goal of the lesson was reached.",
    )
    .grain(0.5, "Go straight from one step to the next, without searching and waiting between them"),
    less("duration_s", "Time", "s", "From the first sample to the last.").grain(0.5, "Waste less time"),
    less("moving_s", "Time in motion", "s", "Time in which the middle between the tips was faster than 5 mm/s.")
        .grain(0.5, "Make fewer and shorter motions"),
    less("path_length_m", "Path", "m", "Length of each tip's path, up to 10 Hz so that noise of sensors adds nothing; for a score both together.")
        .grain(0.01, "Take the straight way: look where you want to go before you move"),
    neutral("range_m", "Room used", "m", "Width and height of the box that both tips stayed in."),
    less("peak_force_n", "Largest force", "N", "Largest force of a finger at any sample.")
        .grain(0.2, "Press less hard: close the fingers only until nothing slips"),
    less(
        "rms_force_n",
        "Force",
        "N",
        "Root mean square of the larger finger's force while one pressed more than 0.05 N.",
    )
    .grain(0.1, "Hold more lightly all the time, not only at the beginning"),
    less("over_limit_s", "Time above the limit", "s", "Time in which a finger pressed more than the limit.")
        .grain(0.1, "Stay below the force limit: watch the red line of the gauges"),
    neutral("limit_n", "Limit", "N", "The force above which a press counts as too hard."),
    more(
        "sparc",
        "Smoothness (spectral arc length)",
        "",
        "Negative length of the speed's amplitude spectrum up to 10 Hz (amplitude threshold 0.05, padding level 4; Balasubramanian \
         et al. 2015). Nearer zero is smoother.",
    )
    .grain(0.3, "Move in one flow: begin and end each motion softly"),
    more(
        "log_dimensionless_jerk",
        "Smoothness (jerk)",
        "",
        "Minus the logarithm of duration³ / peak speed² times the integrated squared second derivative of the speed (Hogan and \
         Sternad 2009). Larger is smoother.",
    )
    .grain(0.3, "Move in one flow: begin and end each motion softly"),
    less("grasps", "Grasps", "", "How often both fingers took the block.")
        .grain(0.5, "Take hold once: put the fingers around the object before you close them"),
    less("drops", "Drops", "", "Times a block fell more than 3 mm after it was let go, with the height.")
        .grain(0.5, "Let go only when the block stands: lower it until the force towards the table shows"),
    less("slips", "Slips", "", "Times a pad slid more than 0.5 mm over a block that both fingers held.")
        .grain(0.5, "Pinch a little more firmly before you lift"),
    less(
        "stacks.offset_m",
        "Offset of a stack",
        "m",
        "Middle of the upper block beside that of the lower one at the end, to the right; for a score the largest, without its sign.",
    )
    .grain(0.0005, "Stop above the lower block and look whether the middles agree before you put it down"),
    less("stacks.tilt_rad", "Tilt of a stack", "rad", "Angle of the upper block from upright at the end.")
        .grain(0.01, "Put the block down level, and let both fingers go at the same time"),
    less("carried_m", "Way carried", "m", "Way of the block's middle while both fingers held it.")
        .grain(0.005, "Carry on the shortest way that clears what stands there"),
    neutral(
        "displaced_m",
        "Way needed",
        "m",
        "Straight way from where the block was first taken to where it was last let go.",
    ),
    less("spilled_kg", "Spilled", "kg", "Content that ran out until the end.")
        .grain(0.001, "Squeeze less, and do not leave a leaking barrel standing"),
    neutral("broken", "Broken", "", "Walls that broke."),
    less(
        "at_rest_since_s",
        "Done",
        "s",
        "Since when everything has been resting with nothing held; absent while it is not.",
    )
    .grain(0.5, "Leave things alone once they stand"),
    neutral("turns", "Turns", "", "Angle that the crank went through, both ways together."),
    less("reversals", "Reversals", "", "Times the crank's direction changed by more than 0.05 rad.")
        .grain(0.5, "Keep turning the same way"),
    less(
        "off_tangent_j",
        "Effort off the tangent",
        "J",
        "Radial force on the handle summed along its way: effort that turns nothing.",
    )
    .grain(0.005, "Follow the circle: pull along it, not towards its middle"),
    less("speed_variation", "Unevenness", "", "Standard deviation of the crank's speed over its mean while it turned.")
        .grain(0.02, "Keep the speed: push less where it turns easily, more where it resists"),
    neutral("mean_speed_rad_s", "Speed", "rad/s", "Mean speed of the crank while it turned."),
    less(
        "punctures.overshoot_m",
        "Overshoot",
        "m",
        "How much farther the needle went in the half second after the sheet gave way; for a score the largest.",
    )
    .grain(0.0003, "Push more slowly as the sheet gets stiff, ready to stop when it gives way"),
    less("punctures.along_m", "Lateral error", "m", "Where the sheet was pierced, from its middle; for a score the largest, without its sign.")
        .grain(0.0005, "Bring the point above its place before you push"),
    less("touched", "Places touched", "", "How many places of the sheet the needle has touched.")
        .grain(0.5, "Touch the sheet once, where it is to be pierced"),
    less("deepest_m", "Deepest insertion", "m", "How far the point went beyond the undisturbed sheet at the most.")
        .grain(0.0005, "Stop pushing as soon as the sheet gives way"),
    neutral("throws", "Throws", "", "Times the switch went over from one side to the other."),
    less("fell_back", "Fell back", "", "Times the knob was pushed a third of its way or more and went back.")
        .grain(0.5, "Push until it snaps before you let go"),
    less(
        "stop_force_n",
        "Force at the stop",
        "N",
        "Largest force of a finger while the knob stood at one of its ends.",
    )
    .grain(0.1, "Give way when it snaps: the switch does the rest"),
];
