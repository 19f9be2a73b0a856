//! Forms of laws, and relations of a cause to other causes and to the recording.

/// Variable of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Over {
    Motion,
    Place,
    Time,
    /// Path of the tip.
    Path,
}

/// Exactness of a law, with its variables. If the true curve has another form than an empirical one, the misfit looks
/// like a weak cause over the same variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    Exact(&'static [Over]),
    Curve(&'static [Over]),
}

impl Form {
    /// Variables of the law.
    pub(crate) fn over(self) -> &'static [Over] {
        match self {
            Self::Exact(over) | Self::Curve(over) => over,
        }
    }

    /// Variables of an empirical curve; empty for an exact law.
    pub(crate) fn of_curve(self) -> &'static [Over] {
        match self {
            Self::Exact(_) => &[],
            Self::Curve(over) => over,
        }
    }
}

/// Relation of a cause to other causes or to the recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Relation {
    /// Is dry friction.
    DryFriction,
    /// Changes dry friction, and needs it.
    OfDryFriction,
    /// A first value without a unit is a share of the model's dry friction.
    ShareOfDryFriction,
    /// Is a part of the dry friction, which is smaller by it.
    TakesDryFriction,
    /// Loses motion at a reversal.
    LosesMotion,
    /// May settle with a time constant, as sensors and leaks do.
    Settles,
    /// Only a force sensor or a driving force shows it.
    NeedsForce,
    /// In a one-way motion that slows down it acts like friction, or like its dependence on speed.
    NeedsBothWays,
    /// Has the same regressor as the other cause for every motion; the reason, in words.
    SameAs(&'static str, &'static str),
}
