//! Names of the recordings and worlds that pictures are drawn from.

/// Source of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sample {
    /// The built-in recording of two blocks.
    Stack,
    /// The built-in recording of a crank.
    Crank,
    /// The scripted operator with the needle.
    Needle,
    /// A tool that opens a door.
    Door,
    /// A crank with an eccentric mass, or on a tilted table: the recording cannot discriminate.
    Askew,
    /// A block that leaks, or is weighed by a drifting sensor: the recording cannot discriminate.
    Leaking,
    /// A hinge with an eccentric mass, or on a tilted axis: the recording cannot discriminate.
    Hinge,
    /// A cart on a rail, of which only position and force are known.
    Rail,
    /// A table whose columns are not yet mapped.
    Foreign,
    /// A built-in world, performed live.
    World(&'static str),
}
