//! Reading of column names as people write them, in English, German, and words of other languages: `force_left_x`, `Kraft rechts Y [N]`, `posX`.

use crate::ui::column_mapping::file_units::MECHANICAL;
use estimator::log::units::Dimension;
use estimator::log::written_units::{Written, in_header, parse};

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Time.
    Time,
    /// Position.
    Position,
    /// Angle.
    Angle,
    /// Linear velocity.
    Velocity,
    /// Angular velocity.
    AngularVelocity,
    /// Force.
    Force,
    /// Torque.
    Torque,
    /// Number or name of one recording among several.
    Trial,
    /// Name of a state.
    Label,
}

impl Kind {
    /// Dimensions that its unit may have.
    pub fn dimensions(self) -> &'static [Dimension] {
        match self {
            Self::Time => &[Dimension::Time],
            Self::Position => &[Dimension::Length],
            Self::Angle => &[Dimension::Angle],
            Self::Velocity => &[Dimension::Velocity],
            Self::AngularVelocity => &[Dimension::AngularVelocity],
            Self::Force => &[Dimension::Force],
            Self::Torque => &[Dimension::Torque],
            Self::Trial | Self::Label => &[],
        }
    }

    /// Kind that a unit alone suggests.
    fn of_dimension(dimension: Dimension) -> Option<Self> {
        [Self::Time, Self::Position, Self::Angle, Self::Velocity, Self::AngularVelocity, Self::Force, Self::Torque]
            .into_iter()
            .find(|kind| kind.dimensions().contains(&dimension))
    }
}

/// A direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Horizontal, positive to the right.
    X,
    /// Vertical, positive up.
    Y,
    /// Out of the plane.
    Z,
}

/// A joint of a finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// At the base.
    Bottom,
    /// Between the links.
    Top,
}

/// Meaning of a column's name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The quantity.
    pub kind: Option<Kind>,
    /// Its direction.
    pub axis: Option<Axis>,
    /// Number or side of a finger: 1 is left, 2 is right.
    pub finger: Option<u32>,
    /// The joint.
    pub joint: Option<Joint>,
    /// Points for the confidence of the reading.
    pub points: i32,
    /// Words that do not name the quantity itself.
    pub words: Vec<String>,
}

/// Points of a named quantity, and of one that only the unit suggests.
const NAMED: i32 = 10;
const BY_UNIT: i32 = 8;

/// Reads a column's name.
pub fn read(header: &str) -> Reading {
    let (name, unit) = in_header(header, &[]);
    let words = words(name);
    let mut reading = Reading::default();
    let (mut kinds, mut doubt, mut bonus, mut processed) = (Vec::new(), 0, 0, 0);
    for (at, word) in words.iter().enumerate() {
        let is_input = at > 0 && ["ch", "channel", "ai", "input", "kanal"].contains(&words[at - 1].as_str());
        match meaning(word) {
            Meaning::Finger(_) if is_input => {}
            Meaning::Kind(kind) => kinds.push(kind),
            Meaning::Along(kind, axis) => {
                kinds.extend(kind);
                reading.axis = Some(axis);
            }
            Meaning::OfJoint(kind, joint) => {
                kinds.push(kind);
                reading.joint = Some(joint);
            }
            Meaning::Joint(joint) => reading.joint = Some(joint),
            Meaning::Finger(number) => reading.finger = Some(number),
            Meaning::Measured => bonus = 2,
            Meaning::Doubtful => doubt = 5,
            Meaning::Processed => processed = 1,
            Meaning::SomethingElse => return Reading { words, ..Reading::default() },
            Meaning::Rate => kinds.push(Kind::Velocity),
            Meaning::None => {}
        }
    }
    let by_unit = match parse(unit, &MECHANICAL) {
        Written::Known(dimension, _) => Kind::of_dimension(dimension),
        _ => None,
    };
    let fallback = reading.axis.map(|_| Kind::Position).or(by_unit);
    reading.points = if kinds.is_empty() && reading.axis.is_none() { BY_UNIT } else { NAMED } + bonus - doubt;
    // A filter delays and attenuates: the raw channel comes first.
    reading.points -= if reading.points > BY_UNIT { processed } else { 0 };
    reading.kind = combined(&kinds, by_unit).or(fallback).filter(|_| reading.points >= BY_UNIT);
    reading.words = words.into_iter().filter(|w| !matches!(meaning(w), Meaning::Kind(_))).collect();
    reading
}

/// One quantity from several words: the force of a position sensor is a force, the rate of an angle an angular
/// velocity.
fn combined(kinds: &[Kind], by_unit: Option<Kind>) -> Option<Kind> {
    use Kind::{Angle, AngularVelocity, Force, Label, Position, Time, Torque, Trial, Velocity};
    let has = |kind| kinds.contains(&kind);
    // A unit decides between words that are all present: `angle_rate_deg`, `joint velocity rad/s`.
    if has(Velocity) && (by_unit == Some(AngularVelocity) || has(Angle)) {
        return Some(AngularVelocity);
    }
    // The position of a shaft may be in turns, and that of a load is no force.
    if by_unit.is_some_and(has) || has(Position) && by_unit == Some(Angle) {
        return by_unit;
    }
    [Torque, Force, AngularVelocity, Velocity, Angle, Position, Time, Trial, Label].into_iter().find(|kind| has(*kind))
}

enum Meaning {
    Kind(Kind),
    Along(Option<Kind>, Axis),
    OfJoint(Kind, Joint),
    Joint(Joint),
    Finger(u32),
    Rate,
    Measured,
    Doubtful,
    Processed,
    SomethingElse,
    None,
}

/// Words for the quantities, in English, German, French, Spanish, Russian, and Chinese.
const QUANTITIES: [(Kind, &str); 7] = [
    (
        Kind::Time,
        "t time zeit stamp timestamp zeitstempel clock uhrzeit elapsed \
         ts tick ticks millis micros ms us datenum время 时间 tiempo temps 时刻",
    ),
    (
        Kind::Position,
        "pos position weg lage ort tip tcp displacement disp \
         auslenkung hub stroke travel extension schlitten перемещение положение 位移 位置",
    ),
    (Kind::Angle, "angle winkel theta phi alpha q drehwinkel rotation encoder угол 角度"),
    (Kind::Velocity, "v vel velocity speed geschwindigkeit geschw"),
    (Kind::AngularVelocity, "omega dq qd qdot winkelgeschwindigkeit drehzahl thetadot"),
    (Kind::Force, "f force forces kraft zugkraft druckkraft loadcell load kraftsensor effort сила усилие 力"),
    (Kind::Torque, "tau torque moment drehmoment tq trq couple момент 扭矩"),
];

fn meaning(word: &str) -> Meaning {
    use Meaning::{Doubtful, Finger, Measured, Processed, Rate, SomethingElse};
    // The first place of a list is no finger.
    if let Ok(number) = word.parse() {
        return if number == 0 { Meaning::None } else { Finger(number) };
    }
    if let Some((kind, _)) = QUANTITIES.iter().find(|(_, words)| words.split(' ').any(|known| known == word)) {
        return Meaning::Kind(*kind);
    }
    if let Some(component) = component(word) {
        return component;
    }
    match word {
        "rate" | "dot" | "angular" => Rate,
        // The reader decides if `segment` stands for runs or for the phases of one.
        run if run != "segment" && estimator::log::counts_runs(run) => Meaning::Kind(Kind::Trial),
        "label" | "state" | "zustand" | "phase" | "annotation" => Meaning::Kind(Kind::Label),
        "bottom" | "unten" | "unteres" | "lower" | "proximal" => Meaning::Joint(Joint::Bottom),
        "top" | "oben" | "oberes" | "upper" | "distal" => Meaning::Joint(Joint::Top),
        "left" | "links" | "linke" | "linker" | "l" | "li" => Finger(1),
        "right" | "rechts" | "rechte" | "rechter" | "r" | "re" => Finger(2),
        "measured" | "meas" | "ist" | "actual" | "act" | "sensor" | "gemessen" => Measured,
        // Set points in German: `Sollweg`.
        set if set.starts_with("soll") => Doubtful,
        "command" | "cmd" | "commanded" | "reference" | "ref" | "desired" | "des" | "set" | "setpoint" | "setting"
        | "target" | "goal" | "estimate" | "est" | "estimated" | "equilibrium" | "simulated" | "sim" | "predicted"
        | "model" | "max" | "min" => Doubtful,
        "filtered" | "filt" | "smoothed" | "smooth" | "lowpass" | "gefiltert" | "avg" | "mean" => Processed,
        "acc" | "accel" | "acceleration" | "beschleunigung" | "jerk" | "current" | "strom" | "voltage" | "spannung"
        | "temp" | "temperature" | "temperatur" | "pressure" | "druck" | "error" | "fehler" | "cov" | "std"
        | "sequence" | "seq" | "counter" | "status" | "orientation" | "quat" | "qw" | "qx" | "qy" | "qz" | "wx"
        | "wy" | "wz" | "frequency" | "frequenz" => SomethingElse,
        _ => Meaning::None,
    }
}

/// Meaning of the name of a vector's component, or of a joint's coordinate.
fn component(word: &str) -> Option<Meaning> {
    use Meaning::{Along, OfJoint};
    Some(match word {
        "x" => Along(None, Axis::X),
        "y" => Along(None, Axis::Y),
        "z" => Along(None, Axis::Z),
        "fx" => Along(Some(Kind::Force), Axis::X),
        "fy" => Along(Some(Kind::Force), Axis::Y),
        "fz" => Along(Some(Kind::Force), Axis::Z),
        "vx" | "xdot" | "xd" => Along(Some(Kind::Velocity), Axis::X),
        "vy" | "ydot" | "yd" => Along(Some(Kind::Velocity), Axis::Y),
        "vz" | "zdot" | "zd" => Along(Some(Kind::Velocity), Axis::Z),
        "px" | "posx" => Along(Some(Kind::Position), Axis::X),
        "py" | "posy" => Along(Some(Kind::Position), Axis::Y),
        "pz" | "posz" => Along(Some(Kind::Position), Axis::Z),
        "qb" => OfJoint(Kind::Angle, Joint::Bottom),
        "qt" => OfJoint(Kind::Angle, Joint::Top),
        "dqb" => OfJoint(Kind::AngularVelocity, Joint::Bottom),
        "dqt" => OfJoint(Kind::AngularVelocity, Joint::Top),
        _ => return None,
    })
}

/// `forceLeftX` → force, left, x; `Fx1` → fx, 1; `Prüf-Kraft` → pruef, kraft.
pub fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut last: Option<char> = None;
    for c in name.chars() {
        let joins = last.is_some_and(|last| {
            c.is_alphanumeric()
                && last.is_alphanumeric()
                && c.is_numeric() == last.is_numeric()
                && !(last.is_lowercase() && c.is_uppercase())
        });
        last = Some(c);
        if !c.is_alphanumeric() {
            continue;
        }
        if !joins {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut() {
            for lower in c.to_lowercase() {
                match lower {
                    'ä' => word.push_str("ae"),
                    'ö' => word.push_str("oe"),
                    'ü' => word.push_str("ue"),
                    'ß' => word.push_str("ss"),
                    other => word.push(other),
                }
            }
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fall_into_words() {
        assert_eq!(words("forceLeftX"), ["force", "left", "x"]);
        assert_eq!(words("Fx1"), ["fx", "1"]);
        assert_eq!(words("tip1.position.x"), ["tip", "1", "position", "x"]);
        assert_eq!(words("Prüf-Kraft"), ["pruef", "kraft"]);
    }

    #[test]
    fn quantities_are_told_from_words_and_units() {
        for (header, kind) in [
            ("force_left_x", Some(Kind::Force)),
            ("Kraft rechts Y [N]", Some(Kind::Force)),
            ("tip force", Some(Kind::Force)),
            ("pos.x", Some(Kind::Position)),
            ("joint velocity (rad/s)", Some(Kind::AngularVelocity)),
            ("theta dot", Some(Kind::AngularVelocity)),
            ("stamp", Some(Kind::Time)),
            ("motor_current_A", None),
            ("position setpoint", None),
            ("acc_x", None),
            ("qw", None),
            ("comment", None),
            ("Sollweg (mm)", None),
            ("F/T Sequence", None),
            ("Messwert [mm]", Some(Kind::Position)),
            ("Load [kip]", Some(Kind::Force)),
            ("CH1 [mm]", Some(Kind::Position)),
        ] {
            assert_eq!(read(header).kind, kind, "{header}");
        }
    }
}
