//! Motions that show parameters, in the words of an order.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A motion that shows something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// Nothing new.
    GoOn,
    /// Fingers off everything for a second.
    LetGo,
    /// Held still above the ground.
    HoldAboveGround,
    /// Lifted and lowered quickly.
    LiftAndLower,
    /// The pinch changes.
    SqueezeMoreAndLess,
    /// The pinch is loosened until the object slides.
    LoosenUntilItSlides,
    /// All the way round.
    FullTurn,
    /// Both directions.
    Reverse,
    /// Slowly and fast.
    OtherSpeeds,
    /// Changing speed within a turn.
    Accelerate,
    /// Pressed towards the centre and drawn from it.
    PushAndPull,
    /// A block is set down, pressed, and lifted again.
    SetDownAgain,
    /// A needle through the sheet and out again.
    PushThroughAndBack,
    /// A needle to and fro in its hole.
    MoveInTheHole,
    /// A needle still, outside of the sheet.
    HoldInTheAir,
    /// A switch over and back, slowly.
    ThrowSlowlyBothWays,
    /// A switch pressed on at its ends.
    PressOnBothStops,
    /// A resting knob touched by one finger after the other.
    TouchFromBothSides,
    /// A switch thrown while both fingers hold it.
    ThrowBetweenFingers,
    /// A cable pulled until it holds.
    PullTaut,
    /// A taut cable pulled in other directions.
    PullOtherWays,
    /// A mechanism at several speeds.
    MoveAtOtherSpeeds,
    /// A mechanism faster and slower.
    ChangeSpeed,
    /// A mechanism slowly through everything it can reach.
    SlowlyThroughAllAngles,
    /// A tool along a surface.
    SlideAlong,
    /// A body thrown once more.
    ThrowAgain,
    /// Nothing that is done in such a recording.
    NoMotion,
}

impl Motion {
    /// The motion as an order.
    pub fn words(self) -> &'static str {
        match self {
            Self::GoOn => "go on as before",
            Self::LetGo => "let go for a second, with the fingers off everything",
            Self::HoldAboveGround => "hold it still above the ground",
            Self::LiftAndLower => "lift and lower it more quickly",
            Self::SqueezeMoreAndLess => "squeeze more, then less, while holding it",
            Self::LoosenUntilItSlides => "loosen the pinch until it begins to slide",
            Self::FullTurn => "turn it all the way round",
            Self::Reverse => "reverse the direction a few times",
            Self::OtherSpeeds => "turn at other speeds, slowly and fast",
            Self::Accelerate => "speed up and slow down within a turn",
            Self::PushAndPull => "push towards the centre and pull away from it while turning",
            Self::SetDownAgain => "set it down, let go, and lift it again, a few times",
            Self::PushThroughAndBack => "push slowly until it goes through, pull out, and do it again at another place",
            Self::MoveInTheHole => "once through, move on and back out at an even speed, a few times",
            Self::HoldInTheAir => "hold it still in the air for some seconds, and let go of it once",
            Self::ThrowSlowlyBothWays => "throw it slowly both ways, a few times",
            Self::PressOnBothStops => "press gently on at both ends of its travel",
            Self::TouchFromBothSides => "touch the resting knob from one side, leave it, then from the other",
            Self::ThrowBetweenFingers => "hold it between both fingers and throw it, slowly and then quickly",
            Self::PullTaut => "pull slowly until the cable holds, give way, and pull again",
            Self::PullOtherWays => "keep the cable taut and move around, in other directions",
            Self::MoveAtOtherSpeeds => "move it at several speeds, slowly and fast",
            Self::ChangeSpeed => "speed it up and slow it down, as quickly as it allows",
            Self::SlowlyThroughAllAngles => "move it slowly through all its angles, or hold it still at several",
            Self::SlideAlong => "slide along the surface, to and fro, while pressing more and less",
            Self::ThrowAgain => "throw it again, so that it slides farther",
            Self::NoMotion => "no motion of such a recording shows it better; state it if it is known",
        }
    }
}
