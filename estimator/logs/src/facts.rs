//! Facts that a sidecar may state: refusals in plain words, and doubts that become warnings.

use super::units;
use foundation::signal::wrench::doubtful_orientation;
use haptics::recording::REPAIRS;
use haptics::recording::{JoinedFile, Meta, OwnClock, Recording, Task, TimeWindow, Warning};
use serde_json::Value;

/// Key of simulated recordings, which is for people. Other keys without a type are kept, with a warning.
const SIMULATED_OBJECT: &str = "simulated_object";
/// Axes that may point up.
const UP: [&str; 7] = ["x", "y", "z", "-x", "-y", "-z", "none"];
/// Known parameters that are above zero.
const POSITIVE: [&str; 14] = [
    "mass_kg",
    "inertia_kg_m2",
    "com_m",
    "radius_m",
    "width_m",
    "height_m",
    "stiffness_N_m",
    "shear_stiffness_N_m",
    "constraint_stiffness_N_m",
    "pad_stiffness_N_m",
    "empty_mass_kg",
    "added_weight_N",
    "added_lever_m",
    "half_width_m",
];
/// Known parameters that are not below zero.
const NOT_NEGATIVE: [&str; 9] = [
    "weight_N",
    "friction_mu",
    "friction",
    "friction_lower_bound",
    "viscous_N_s_m",
    "viscous_Nm_s",
    "coulomb_N",
    "coulomb_Nm",
    "puncture_force_N",
];
/// Known parameters of either sign.
const SIGNED: [&str; 8] = [
    "offset_N",
    "offset_Nm",
    "gravity_moment_Nm",
    "gravity_phase_rad",
    "center_x_m",
    "center_y_m",
    "surface_position_m",
    "added_level_rad",
];
/// `rate_hz` and the time column may differ by this share.
const RATE_TOLERANCE: f64 = 0.05;

/// The first value in the sidecar of a kind that cannot be meant, in words; `None` when every one can be read.
pub fn wrong_type(sidecar: &Value) -> Option<String> {
    let Value::Object(entries) = sidecar else {
        return Some(format!("it holds {} and must hold an object in braces", kind(sidecar)));
    };
    entries.iter().find_map(|(key, value)| entry(key, value))
}

fn entry(key: &str, value: &Value) -> Option<String> {
    if value.is_null()
        && matches!(key, "task" | "rate_hz" | "gravity_m_s2" | "up" | "wrench_frame" | "hand" | "from_s" | "to_s")
    {
        return None;
    }
    match key {
        "task" => task(value),
        "rate_hz" | "gravity_m_s2" | "from_s" | "to_s" => must(key, value, value.is_number(), "a number"),
        "several_clocks" => must(key, value, value.is_boolean(), "true or false"),
        "up" => must(key, value, value.is_string(), "a text like \"y\""),
        "wrench_frame" => must(
            key,
            value,
            value == "sensor" || value == "base",
            "\"sensor\" (axes that turn with the sensor) or \"base\" (axes of the orientation)",
        ),
        "hand" => members(key, value, &hand_member),
        "columns" => members(key, value, &|k, v| {
            must(k, v, v.is_string() || v.is_null(), "a column's name in quotes, or null for none")
        }),
        "scale" | "sign" | "known" | "compensated" => {
            members(key, value, &|k, v| must(k, v, v.is_number(), "a number"))
        }
        "prior" => members(key, value, &|k, v| {
            let number = |part: &str| v.get(part).is_some_and(Value::is_number);
            must(k, v, number("mean") && number("std"), "an object with two numbers, \"mean\" and \"std\"")
        }),
        "bounds" => members(key, value, &|k, v| {
            let side = |v: &Value| v.is_null() || v.is_number();
            let pair = v.as_array().is_some_and(|a| a.len() == 2 && a.iter().all(side));
            must(k, v, pair, "two numbers in brackets, or null for a side that is open")
        }),
        "as_recorded" => {
            let known = |list: &Vec<Value>| list.iter().all(|v| REPAIRS.iter().any(|kind| v == kind));
            let wanted = format!("a list of some of {}", REPAIRS.join(", "));
            must(key, value, value.as_array().is_some_and(known), &wanted)
        }
        "missing" => missing(value),
        "select" => {
            let simple = |v: &Value| v.is_string() || v.is_number() || v.is_boolean();
            let several = |v: &Value| v.as_array().is_some_and(|all| !all.is_empty() && all.iter().all(simple));
            members(key, value, &|k, v| must(k, v, simple(v) || several(v), "a text, a number, or a list of them"))
        }
        "windows" => {
            let windows = serde_json::from_value::<Vec<TimeWindow>>(value.clone());
            must(key, value, windows.is_ok(), "a list like [{\"from_s\": 2, \"to_s\": 8}]")
        }
        "clocks" => members(key, value, &|k, v| {
            let wanted = "a column of times in quotes, or {\"column\": its name, \"offset_s\": seconds}";
            must(k, v, serde_json::from_value::<OwnClock>(v.clone()).is_ok(), wanted)
        }),
        "join" => {
            let files = serde_json::from_value::<Vec<JoinedFile>>(value.clone());
            must(key, value, files.is_ok(), "a list like [{\"file\": \"force.csv\", \"offset_s\": 0}]")
        }
        _ => None,
    }
}

fn task(value: &Value) -> Option<String> {
    let known = serde_json::from_value::<Task>(value.clone()).is_ok();
    let folder = foundation::tasks::library::folder();
    let own = folder.map_or_else(String::new, |folder| format!(", or a task of yours in {}", folder.display()));
    must(
        "task",
        value,
        known,
        &format!("one of block-stack, crank, needle, mechanism, barrel, switch and payload{own}"),
    )
}

fn missing(value: &Value) -> Option<String> {
    let is_text = |v: &Value| v.as_str().is_some_and(|text| !text.parse::<f64>().is_ok_and(f64::is_finite));
    let are_texts = value.as_array().is_some_and(|all| !all.is_empty() && all.iter().all(is_text));
    must("missing", value, are_texts, "a list of texts that are no numbers, like [\"NaN\", \"OVLD\"]")
}

fn hand_member(key: &str, value: &Value) -> Option<String> {
    let name = key.rsplit(' ').next().unwrap_or(key);
    let pair = || value.as_array().is_some_and(|a| a.len() == 2 && a.iter().all(Value::is_number));
    match name {
        _ if value.is_null() => None,
        "link_m" => must(key, value, value.is_number(), "a number"),
        "base_m" | "base1_m" | "base2_m" => must(key, value, pair(), "two numbers in brackets"),
        _ => None,
    }
}

fn members(key: &str, value: &Value, check: &dyn Fn(&str, &Value) -> Option<String>) -> Option<String> {
    let Value::Object(entries) = value else { return must(key, value, false, "an object in braces") };
    entries.iter().find_map(|(name, value)| check(&format!("{key} of {name}"), value))
}

fn must(key: &str, value: &Value, fine: bool, wanted: &str) -> Option<String> {
    (!fine).then(|| format!("{key} is {} and must be {wanted}", kind(value)))
}

/// A JSON value for people.
fn kind(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(flag) => flag.to_string(),
        Value::Number(number) => number.to_string(),
        Value::String(text) => format!("the text {text:?}"),
        Value::Array(_) => "a list".to_owned(),
        Value::Object(_) => "an object".to_owned(),
    }
}

/// The first fact in the sidecar that cannot be.
pub fn complaint(meta: &Meta) -> Option<String> {
    if let Some(rate) = meta.rate_hz.filter(|r| !(r.is_finite() && *r > 0.0)) {
        return Some(format!("rate_hz is {rate} and must be positive"));
    }
    if let Some(g) = meta.gravity_m_s2.filter(|g| !(g.is_finite() && *g > 0.0)) {
        return Some(format!(
            "gravity_m_s2 is {g} and must be positive; say \"up\": \"none\" where gravity does not act, \"up\": \"-y\" where y points down"
        ));
    }
    if let Some(up) = meta.up.as_deref().filter(|up| !UP.contains(up)) {
        return Some(format!("up is {up:?} and must be one of {}", UP.join(", ")));
    }
    if let Some((name, value)) = meta.sign.iter().find(|(_, v)| v.abs() != 1.0) {
        return Some(format!("sign of {name} is {value} and must be 1 or -1"));
    }
    if let Some((name, value)) = meta.scale.iter().find(|(_, v)| !v.is_finite() || **v == 0.0) {
        return Some(format!("scale of {name} is {value} and must be a number other than 0"));
    }
    if let Some(link) = meta.hand.as_ref().and_then(|h| h.link_m).filter(|l| !(l.is_finite() && *l > 0.0)) {
        return Some(format!("link_m of hand is {link} and must be positive"));
    }
    if let Some((name, prior)) =
        meta.prior.iter().find(|(_, p)| !(p.mean.is_finite() && p.std.is_finite() && p.std > 0.0))
    {
        return Some(format!(
            "the prior of {name} is {} ± {} and must be a number with a standard deviation above 0; a value that is certain belongs in \"known\"",
            prior.mean, prior.std
        ));
    }
    if let Some((name, [low, high])) = meta.bounds.iter().find(|(_, b)| matches!(b, [Some(l), Some(h)] if l >= h)) {
        let (low, high) = (low.unwrap_or_default(), high.unwrap_or_default());
        return Some(format!("the bounds of {name} are {low} and {high}; the first must be the smaller one"));
    }
    if let Some(window) = meta.windows().iter().find(|w| w.from_s.zip(w.to_s).is_some_and(|(from, to)| from >= to)) {
        let (from, to) = (window.from_s.unwrap_or_default(), window.to_s.unwrap_or_default());
        return Some(format!("the window of time from_s {from} to_s {to} is empty; the first must be the smaller one"));
    }
    if !meta.windows.is_empty() && (meta.from_s.is_some() || meta.to_s.is_some()) {
        return Some("it has \"windows\" and \"from_s\" or \"to_s\"; state the window of time once".to_owned());
    }
    meta.known.iter().find_map(|(name, value)| impossible(last_part(name), *value))
}

/// The parameter's name without the object's.
fn last_part(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

fn impossible(name: &str, value: f64) -> Option<String> {
    let wanted = match name {
        _ if !value.is_finite() => "a finite number",
        _ if POSITIVE.contains(&name) && value <= 0.0 => "above 0",
        _ if NOT_NEGATIVE.contains(&name) && value < 0.0 => "0 or more",
        _ => return None,
    };
    Some(format!("known {name} is {value} and must be {wanted}"))
}

/// An axis that points up but that recordings of this form are not read with: better refused than ignored.
pub fn up_not_honoured(recording: &Recording) -> Option<String> {
    let up = recording.meta.up.as_deref().unwrap_or("y");
    let fingers = ["x1_m", "x2_m", "qb1_rad", "qb2_rad", "qb_rad"].iter().any(|c| recording.channel(c).is_some());
    let task = recording.meta.task;
    let (what, fine) = match task {
        Some(Task::Crank) => ("cranks are read with y up or -y up", matches!(up, "y" | "-y")),
        Some(Task::BlockStack) => ("blocks are read with y up", up == "y"),
        Some(Task::Barrel) => ("barrels are read with y up", up == "y"),
        Some(Task::Needle) => ("needles are read in the plane of x and y", !matches!(up, "z" | "-z")),
        None if fingers => ("fingertips are read with y up", matches!(up, "y" | "-y")),
        _ => return None,
    };
    let flat = if up == "none" && task == Some(Task::Crank) {
        "; where gravity does not act, state \"known\": {\"weight_N\": 0}"
    } else {
        "; name the vertical column y in \"columns\""
    };
    (!fine).then(|| format!("up is {up:?}, but {what}{flat}"))
}

/// Doubtful statements of the sidecar about this recording.
pub fn doubts(recording: &Recording) -> Vec<Warning> {
    let meta = &recording.meta;
    let warning = |text: String| Warning {
        kind: "sidecar".to_owned(),
        column: None,
        spans: Vec::new(),
        text,
        ..Warning::default()
    };
    let mut found = Vec::new();
    for key in meta.other.keys().filter(|key| *key != SIMULATED_OBJECT) {
        found.push(warning(format!("the sidecar's key `{key}` means nothing to the program; it is kept as it is")));
    }
    let named = |n: &str| {
        let n = last_part(n);
        POSITIVE.contains(&n) || NOT_NEGATIVE.contains(&n) || SIGNED.contains(&n)
    };
    for name in meta.known.keys().filter(|n| !named(n)) {
        found.push(warning(format!(
            "known `{name}` is no parameter of the program and is not used; check its spelling"
        )));
    }
    found.extend(rate_doubt(recording).map(warning));
    found.extend(hand_doubt(recording).map(warning));
    let orientation = |text: String| Warning {
        kind: "orientation".to_owned(),
        column: None,
        spans: Vec::new(),
        text,
        ..Warning::default()
    };
    found.extend(doubtful_orientation(recording).map(orientation));
    found
}

fn rate_doubt(recording: &Recording) -> Option<String> {
    let (rate, time) = (recording.meta.rate_hz?, recording.time_s.as_ref()?);
    let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
    if steps.is_empty() {
        return None;
    }
    let middle = steps.len() / 2;
    let measured = 1.0 / *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    ((rate / measured - 1.0).abs() > RATE_TOLERANCE).then(|| {
        format!(
            "rate_hz is {rate} but the time column runs at {measured:.4} Hz; the time column is used: check its unit"
        )
    })
}

fn hand_doubt(recording: &Recording) -> Option<String> {
    let joints = recording.channels.iter().any(|c| {
        let quantity = units::split(&c.name).map_or("", |(q, _)| q);
        matches!(quantity.trim_end_matches(['1', '2']), "qb" | "qt")
    });
    let stated = recording.meta.hand.as_ref();
    if !joints || stated.is_some_and(|h| h.link_m.is_some() && (h.base_m.is_some() || h.base1_m.is_some())) {
        return None;
    }
    let hand = recording.meta.hand();
    let [one, two] = &hand.fingers;
    let millimetres = |v: f64| 1e3 * v;
    Some(format!(
        "the sidecar does not state the hand that the joint angles belong to: links of {:.0} mm and bases at ({:.0}, {:.0}) and ({:.0}, {:.0}) mm are assumed; give \"hand\" with link_m and base_m or base1_m, base2_m",
        millimetres(one.link_m),
        millimetres(one.base_m.x),
        millimetres(one.base_m.y),
        millimetres(two.base_m.x),
        millimetres(two.base_m.y),
    ))
}

#[cfg(test)]
mod tests;
