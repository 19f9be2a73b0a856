//! Units that look wrong by 1000, 100 or 57.3: a velocity that is not its position's, a hand that reaches too far, a force
//! that no finger has.

use super::profile::Profile;
use crate::units;
use haptics::recording::{Channel, Recording, Span, Warning};

/// Factors between units that people mix up, with their names.
const FACTORS: [(f64, &str); 3] = [(1000.0, "1000"), (100.0, "100"), (DEGREES, "57.3")];
/// Degrees of a radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;
/// Millimetres of a metre.
const THOUSAND: (&str, f64) = ("1000", 1000.0);
/// A measured ratio may differ from the factor by this, either way: noise on the velocity lowers it.
const TOLERANCE: f64 = 1.2;
/// Largest difference of a rate from that of its position, as a factor.
/// Choice: a calibrated gyroscope or tachometer is within a few per cent.
const AGREES: f64 = 1.1;
/// Below this correlation over the windows, position and velocity say too little about each other.
const CORRELATED: f64 = 0.9;
/// Largest number of windows over which displacement and mean velocity are compared.
const WINDOWS: usize = 200;
/// Least number of samples in each window.
const WINDOW_SAMPLES: usize = 4;
/// Least number of windows.
const FEWEST_WINDOWS: usize = 10;
/// Largest distance of the tips, in reaches of the hand, with links up to ten times longer than stated.
const FARTHEST_REACHES: f64 = 20.0;
/// Least motion of a working hand, as a share of its reach.
const NEAREST_REACHES: f64 = 1.0 / 500.0;
/// Largest angle of a joint of the hand from zero, rad: three turns.
const FARTHEST_JOINT_RAD: f64 = 19.0;
/// Least angle that some joint of a working hand passes, rad.
const NEAREST_JOINT_RAD: f64 = 0.05;
/// Largest force of a finger, N.
const LARGEST_FINGER_N: f64 = 500.0;
/// Least largest force of fingers that hold anything, N.
const SMALLEST_FINGER_N: f64 = 0.01;
/// Forces on an object of known weight lie within this factor of it.
const WEIGHT_FACTOR: f64 = 200.0;
/// A coordinate of a mechanism does not go further, m: a metre of travel in mm.
const FARTHEST_MECHANISM_M: f64 = 100.0;
/// A coordinate of a mechanism moves no faster, m/s.
/// Choice: belts and linear motors reach a tenth of it; millimetres read as metres exceed it from 50 mm/s on.
const FASTEST_MECHANISM_M_S: f64 = 50.0;
/// Fewer samples do not show a range.
const FEWEST_SAMPLES: usize = 50;

/// Kind of these warnings.
pub const UNIT: &str = "unit";

/// Everything whose unit is doubtful.
pub fn warnings(recording: &Recording, profiles: &[Profile]) -> Vec<Warning> {
    if recording.len() < FEWEST_SAMPLES {
        return Vec::new();
    }
    let mut found = rates(recording);
    found.extend(ranges(recording, profiles));
    if found.is_empty() {
        found.extend(speed(recording));
    }
    found
}

/// Doubt about a mechanism's coordinate that is faster than mechanisms are.
fn speed(recording: &Recording) -> Option<Warning> {
    let (time_s, place_m) = (recording.time_s.as_ref()?, recording.channel("q_m")?);
    let over = (place_m.len() / WINDOWS).max(WINDOW_SAMPLES);
    let speeds = (over..place_m.len()).map(|i| {
        let (way_m, took_s) = (place_m[i] - place_m[i - over], time_s[i] - time_s[i - over]);
        way_m.abs() / took_s
    });
    let mut speeds: Vec<f64> = speeds.filter(|speed| speed.is_finite()).collect();
    // Nine tenths of the samples: a jump of the zero is not a unit.
    let at = speeds.len() * 9 / 10;
    if speeds.is_empty() {
        return None;
    }
    let usual_m_s = *speeds.select_nth_unstable_by(at, f64::total_cmp).1;
    (usual_m_s > FASTEST_MECHANISM_M_S).then(|| {
        let text = format!(
            "q_m moves at {usual_m_s:.0} m/s, faster than a mechanism does: its unit looks wrong by 1000; correct it in the \
             column's name, or give \"scale\" in the sidecar"
        );
        doubt(recording, "q_m", text, &[("q_m", THOUSAND.1.recip())])
    })
}

/// `scale`: factors by channel that would settle the doubt; none if only the user knows them. Whole numbers may be counts,
/// whose factor is asked for.
fn doubt(recording: &Recording, column: &str, text: String, scale: &[(&str, f64)]) -> Warning {
    let counts = |name: &str| recording.channel(name).is_some_and(|values| values.iter().all(|v| v.fract() == 0.0));
    let entry = |(name, factor): &(&str, f64)| {
        let factor = Some(*factor).filter(|_| !counts(name));
        ((*name).to_owned(), factor.map_or(serde_json::Value::Null, Into::into))
    };
    let scale: serde_json::Map<_, _> = scale.iter().map(entry).collect();
    let suggested = (!scale.is_empty()).then(|| serde_json::Map::from_iter([("scale".to_owned(), scale.into())]));
    let all = Span { first: 0, end: recording.len() };
    Warning { kind: UNIT.to_owned(), column: Some(column.to_owned()), spans: vec![all], text, suggested }
}

/// Velocity channels against the changes of their positions.
fn rates(recording: &Recording) -> Vec<Warning> {
    let Some(time) = &recording.time_s else { return Vec::new() };
    let mut found = Vec::new();
    for velocity in &recording.channels {
        let Some(position) = position_of(recording, velocity) else { continue };
        let Some([least, most]) = ratios(time, &position.values, &velocity.values) else { continue };
        if least <= AGREES && most >= AGREES.recip() {
            continue;
        }
        let is_near = |factor: &f64| least / factor < TOLERANCE && factor / least < TOLERANCE;
        let named = FACTORS.into_iter().flat_map(|(factor, name)| {
            [(factor, format!("{name} times"), name), (factor.recip(), format!("1/{name} of"), name)]
        });
        let ratio = (least * most).sqrt();
        let (factor, how, wrong) = named.into_iter().find(|(factor, ..)| is_near(factor)).map_or_else(
            || (None, format!("{} times", short(ratio)), format!("a factor of {}", short(ratio.max(ratio.recip())))),
            |(factor, how, name)| (Some(factor), how, name.to_owned()),
        );
        let text = format!(
            "{} changes at {how} the rate that {} states: the unit of one of the two, or of the time, is wrong by {wrong}; correct it in the column's name, or give \"scale\" in the sidecar",
            position.name, velocity.name
        );
        // No unit has such a factor: another channel, or the clock, may be the wrong one.
        let scale: Vec<(&str, f64)> = factor.map(|factor| (velocity.name.as_str(), factor)).into_iter().collect();
        found.push(doubt(recording, &velocity.name, text, &scale));
    }
    found
}

/// A ratio in three digits.
fn short(ratio: f64) -> String {
    if (0.1..1000.0).contains(&ratio) { format!("{ratio:.2}") } else { format!("{ratio:.1e}") }
}

/// `vx1_m_s` → `x1_m`, `dq_rad_s` → `q_rad`.
fn position_of<'a>(recording: &'a Recording, velocity: &Channel) -> Option<&'a Channel> {
    let (quantity, unit) = units::split(&velocity.name)?;
    let (stem, unit) = match unit.si {
        "m_s" => (quantity.strip_prefix('v').or_else(|| quantity.strip_prefix('d'))?, "m"),
        "rad_s" => (quantity.strip_prefix('d')?, "rad"),
        _ => return None,
    };
    recording.channels.iter().find(|c| units::split(&c.name).is_some_and(|(q, u)| q == stem && u.si == unit))
}

/// Ratios of the rate of the position to the stated velocity over windows long enough that noise averages out: least
/// squares with all errors in the position, and with all of them in the velocity. The true ratio lies between, also if
/// the velocity has passed a first-order low-pass. `None` if the two are hardly correlated.
fn ratios(time: &[f64], position: &[f64], velocity: &[f64]) -> Option<[f64; 2]> {
    let n = time.len();
    let window = (n / WINDOWS).max(WINDOW_SAMPLES);
    let (mut pp, mut pv, mut vv, mut count) = (0.0, 0.0, 0.0, 0);
    let mut first = 0;
    while first + window < n {
        let end = first + window;
        let moved = position[end] - position[first];
        let stated: f64 = (first..end).map(|i| 0.5 * (velocity[i] + velocity[i + 1]) * (time[i + 1] - time[i])).sum();
        (pp, pv, vv) = (pp + moved * moved, pv + moved * stated, vv + stated * stated);
        count += 1;
        first = end;
    }
    let together = pv.abs() > CORRELATED * (pp * vv).sqrt();
    (count >= FEWEST_WINDOWS && together && vv > 0.0).then(|| [(pv / vv).abs(), (pp / pv).abs()])
}

/// Positions, angles and forces against the abilities of a hand.
fn ranges(recording: &Recording, profiles: &[Profile]) -> Vec<Warning> {
    let hand = recording.meta.hand();
    let reach_m = 2.0 * hand.fingers[0].link_m.max(hand.fingers[1].link_m)
        + hand.fingers.iter().map(|f| f.base_m.x.hypot(f.base_m.y)).fold(0.0, f64::max);
    let group = |stems: &[&str], unit: &str, fingered: bool| -> Vec<(&Channel, &Profile)> {
        recording
            .channels
            .iter()
            .zip(profiles)
            .filter(|(c, p)| {
                let Some((quantity, own)) = units::split(&c.name) else { return false };
                let stem = quantity.trim_end_matches(['1', '2']);
                let right = if fingered { stem.len() + 1 == quantity.len() } else { stem == quantity };
                right && own.si == unit && stems.contains(&stem) && !p.is_constant()
            })
            .collect()
    };
    let mut found = Vec::new();
    let mut judge = |members: &[(&Channel, &Profile)],
                     least: f64,
                     most: f64,
                     (factor, value): (&str, f64),
                     what: &str| {
        // Nine tenths of the samples: a spike is not a unit.
        let usual = |p: &Profile| p.quantile(0.05).abs().max(p.quantile(0.95).abs());
        let Some((channel, profile)) = members.iter().max_by(|a, b| usual(a.1).total_cmp(&usual(b.1))) else { return };
        let size = usual(profile);
        let (how, mended) = if size > most {
            ("more", value.recip())
        } else if size < least && profile.reach() < least {
            ("less", value)
        } else {
            return;
        };
        let text = format!(
            "{} goes up to {size:.4} {}, {how} than {what}: its unit looks wrong by {factor}; correct it in the column's name, or give \"scale\" in the sidecar",
            channel.name, channel.unit
        );
        let scale: Vec<(&str, f64)> = members.iter().map(|(c, _)| (c.name.as_str(), mended)).collect();
        found.push(doubt(recording, &channel.name, text, &scale));
    };
    let tips = group(&["x", "y"], "m", true);
    judge(&tips, NEAREST_REACHES * reach_m, FARTHEST_REACHES * reach_m, THOUSAND, "a hand of this size does");
    let joints: Vec<_> = [true, false].into_iter().flat_map(|f| group(&["qb", "qt"], "rad", f)).collect();
    judge(&joints, NEAREST_JOINT_RAD, FARTHEST_JOINT_RAD, ("57.3", DEGREES), "the joints of a hand do");
    let mechanism: Vec<_> = ["q", "x", "y", "z"].into_iter().flat_map(|stem| group(&[stem], "m", false)).collect();
    judge(&mechanism, 0.0, FARTHEST_MECHANISM_M, THOUSAND, "a mechanism or a tool does");
    let fingers = group(&["fx", "fy"], "N", true);
    judge(&fingers, SMALLEST_FINGER_N, LARGEST_FINGER_N, THOUSAND, "fingers can");
    let known = &recording.meta.known;
    let weight = known.get("weight_N").copied().or(known.get("mass_kg").map(|m| m * recording.meta.gravity()));
    if let Some(weight) = weight.filter(|w| *w > 0.0) {
        let all: Vec<_> = [true, false].into_iter().flat_map(|f| group(&["fx", "fy", "fz", "f"], "N", f)).collect();
        judge(&all, weight / WEIGHT_FACTOR, weight * WEIGHT_FACTOR, THOUSAND, "the stated weight lets expect");
    }
    found
}
