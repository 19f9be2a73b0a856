//! Positions of recordings that hold velocities or accelerations only.

use crate::units;
use haptics::recording::{Channel, Recording, Warning};

/// Adds the positions of velocities, and of accelerations, to a recording without any position.
pub fn complete(recording: &mut Recording) -> Vec<Warning> {
    let is_position = |c: &Channel| units::is_program_name(&c.name) && matches!(c.unit.as_str(), "m" | "rad");
    if recording.channels.iter().any(is_position) {
        return Vec::new();
    }
    let Some(time) = recording.time_s.clone().filter(|time| time.len() > 1) else { return Vec::new() };
    let mut said = Vec::new();
    let mut add = |recording: &mut Recording, of: &Channel, (name, unit): (String, &str), values, drift: String| {
        let text = format!("{name} is the integral of {}: its zero is not known, and it drifts. {drift}", of.name);
        said.push(Warning { kind: "integrated".to_owned(), column: Some(name.clone()), text, ..Warning::default() });
        recording.channels.push(Channel { name, unit: unit.to_owned(), values });
    };
    for acceleration in named(recording, &[("m_s2", "m_s"), ("rad_s2", "rad_s")]) {
        let Some((name, unit)) = integral(&acceleration) else { continue };
        if recording.channel(&name).is_some() {
            continue;
        }
        let mut velocity = summed(&time, &acceleration.values);
        let drift = level(&time, &mut velocity);
        let told = format!("The velocity is taken as zero at both ends, which took {drift:.3e} {unit} of drift out.");
        add(recording, &acceleration, (name, unit), velocity, told);
    }
    for velocity in named(recording, &[("m_s", "m"), ("rad_s", "rad")]) {
        let Some((name, unit)) = integral(&velocity) else { continue };
        let position = summed(&time, &velocity.values);
        let (span_s, n) = (time[time.len() - 1] - time[0], time.len() as f64);
        let noise = foundation::signal::noise::white_noise(&velocity.values);
        let told = format!(
            "The noise of the velocity adds up to {:.1e} {unit} over the recording, and an offset of 1e-3 {} to {:.1e} {unit}.",
            noise * span_s / n.sqrt(),
            velocity.unit,
            1e-3 * span_s
        );
        add(recording, &velocity, (name, unit), position, told);
    }
    said
}

/// Channels of the program with one of these units.
fn named(recording: &Recording, kinds: &[(&str, &str)]) -> Vec<Channel> {
    let is_one = |c: &&Channel| units::is_program_name(&c.name) && kinds.iter().any(|(unit, _)| c.unit == *unit);
    recording.channels.iter().filter(is_one).cloned().collect()
}

/// Name and unit of the integral: `ddq_m_s2` → `dq_m_s`, `vx1_m_s` → `x1_m`.
fn integral(of: &Channel) -> Option<(String, &'static str)> {
    let (quantity, _) = units::split(&of.name)?;
    let unit = match of.unit.as_str() {
        "m_s2" => "m_s",
        "rad_s2" => "rad_s",
        "m_s" => "m",
        _ => "rad",
    };
    let stem = quantity.strip_prefix(['v', 'd'])?;
    Some((format!("{stem}_{unit}"), unit))
}

/// Integral from zero, by the trapezoidal rule.
fn summed(time: &[f64], values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = time.windows(2).zip(values.windows(2)).map(|(t, v)| {
        sum += 0.5 * (v[0] + v[1]) * (t[1] - t[0]);
        sum
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// Takes the line through the first and the last value out, and returns its rise.
fn level(time: &[f64], values: &mut [f64]) -> f64 {
    let (last, span_s) = (values[values.len() - 1], time[time.len() - 1] - time[0]);
    values.iter_mut().zip(time).for_each(|(v, t)| *v -= last * (t - time[0]) / span_s);
    last
}
