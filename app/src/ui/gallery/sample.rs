//! Names of the recordings and worlds that pictures are drawn from.

/// What a picture is drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sample {
    /// The built-in recording of two blocks.
    Stack,
    /// The built-in recording of a crank.
    Crank,
    /// The scripted operator with the needle.
    Needle,
    /// A tool that leads a door.
    Door,
    /// A crank with a mass off its axis, or on a tilted table: its recording cannot tell.
    Askew,
    /// A block that leaks, or is weighed by a sensor that drifts: its recording cannot tell.
    Leaking,
    /// A hinge with a mass off its axis, or on an axis that leans: its recording cannot tell.
    Hinge,
    /// A cart on a rail, of which only the way and the force are known.
    Rail,
    /// A table whose columns have no meaning yet.
    Foreign,
    /// A built-in world, performed live.
    World(&'static str),
}
