//! Faults of the measurement that are no force along a coordinate: their pages of the catalogue. What corrects a recording by
//! them is the diagnosis's; `force-bias` and `force-drift` are laws of their own.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};

/// Their pages, in the order they are shown.
pub(super) static ENTRIES: [Entry; 8] = [
    Entry {
        id: "force-gain",
        kind: Kind::Instrument,
        title: "Gain of the force channel",
        equation: "g F",
        about: "Every force is read too large or too small by one factor. It shows in weight, inertia and viscous \
            friction alike, and leaves friction coefficients as they are. A heavier object mimics it. Only a \
            known weight reveals it.",
        parameters: &[ParameterSpec::linear("g", "1", "1", POSITIVE)],
    },
    Entry {
        id: "force-cross-axis",
        kind: Kind::Instrument,
        title: "Cross-talk of the force axes",
        equation: "Fx + κ Fy",
        about: "One force axis reads a share of the other, or the sensor is turned. It shows as a force along the \
            motion that follows the force across it. Friction that differs by direction is identical to it \
            while the load keeps its sign. Pushing and pulling across the motion reveals it.",
        parameters: &[ParameterSpec::linear("kappa", "1", "1", ANY)],
    },
    Entry {
        id: "force-saturation",
        kind: Kind::Instrument,
        title: "Saturated force channel",
        equation: "clip(F, ±F_max)",
        about: "The force is cut off at a level. It shows as flat tops at one value. A slipping grasp mimics it, at \
            a level that follows the grip. The raw samples reveal it; pulling less avoids it.",
        parameters: &[ParameterSpec::nonlinear("F_max", "N", "N m", POSITIVE)],
    },
    Entry {
        id: "time-delay",
        kind: Kind::Instrument,
        title: "Delay between channels",
        equation: "F(t − τ)",
        about: "Force and motion are not of the same instant. It shows as residuals in proportion to the rate of \
            the force, mostly at reversals. Inertia, backlash and presliding friction mimic it in one sine of \
            motion. Fast changes of the force at several speeds reveal it.",
        parameters: &[ParameterSpec::nonlinear("tau", "s", "s", ANY)],
    },
    Entry {
        id: "joint-offset",
        kind: Kind::Instrument,
        title: "Offset of a joint sensor",
        equation: "q + δ",
        about: "The zero of a joint angle is wrong. It shows as a distorted path: a circle becomes an oval, a width \
            depends on the place. Give of the pads mimics it along a short arc. A wide arc, or one object \
            measured at several places, reveals it.",
        parameters: &[ParameterSpec::nonlinear("delta", "rad", "rad", ANY)],
    },
    Entry {
        id: "length-scale",
        kind: Kind::Instrument,
        title: "Scale of lengths",
        equation: "x (1 + ε)",
        about: "All positions are too large or too small by one factor: a wrong link length, a camera. It shows in \
            every width, height and radius alike. Give of the pads mimics it at one grip. An object of known \
            size, gripped softly and hard, reveals it.",
        parameters: &[ParameterSpec::linear("epsilon", "1", "1", ANY)],
    },
    Entry {
        id: "axis-sign",
        kind: Kind::Instrument,
        title: "Mirrored or swapped axis",
        equation: "one channel times −1, or two swapped",
        about: "A channel has the wrong sign or name. It shows as friction that drives, as weight that lifts or as \
            a path in the mirror. A wrong frame of gravity mimics it for one channel. Lifting a known weight \
            and moving once along each axis reveals it.",
        parameters: &[ParameterSpec::nonlinear("which", "1", "1", POSITIVE)],
    },
    Entry {
        id: "channel-fault",
        kind: Kind::Instrument,
        title: "Fault of a channel",
        equation: "stuck, copied, quantised or dropped samples",
        about: "Samples that the sensor did not measure. It shows as runs of one value, steps of one size, or two \
            channels that are the same. Rest mimics a stuck channel, a coarse clock a dropped one. The raw \
            samples of a lively motion reveal it.",
        parameters: &[ParameterSpec::nonlinear("from", "s", "s", ANY), ParameterSpec::nonlinear("to", "s", "s", ANY)],
    },
];
