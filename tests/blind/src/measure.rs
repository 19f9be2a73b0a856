//! How large an effect is beside the noise: what is left of it after the known model has taken what it can.

use super::arm::Arm;
use super::effect::{Effect, Shows};
use super::plant::Hidden;
use super::sensor::{self, Sensor};
use super::simulate::{Sample, Setup};
use super::structure::turned_n;

/// The known terms of a mechanism's model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Weight, load friction and viscous friction of a crank.
    Crank,
    /// A crank of known weight.
    CrankOfKnownWeight,
    /// Inertia only.
    Mass,
    /// Inertia and viscous friction.
    MassViscous,
    /// Inertia, viscous and dry friction.
    MassViscousDry,
}

/// What an effect leaves, and beside which noise.
#[derive(Clone, Debug, Default)]
pub struct Size {
    /// The effect row by row, after the known model took what it could (N or m).
    pub rows: Vec<f64>,
    /// Times of the first of them, s, where an effect shows in the force: those in which the handle moves.
    pub times_s: Vec<f64>,
    /// Standard deviation of the noise in those rows.
    pub noise: f64,
}

impl Size {
    /// Root mean square of the effect.
    pub fn rms(&self) -> f64 {
        (self.rows.iter().map(|v| v * v).sum::<f64>() / self.rows.len().max(1) as f64).sqrt()
    }

    /// Effect over noise.
    pub fn ratio(&self) -> f64 {
        self.rms() / self.noise
    }

    /// Correlation with another effect in the same rows; 0 when they are not the same rows.
    pub fn correlation(&self, other: &Self) -> f64 {
        if self.rows.len() != other.rows.len() {
            return 0.0;
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        dot(&self.rows, &other.rows) / (dot(&self.rows, &self.rows) * dot(&other.rows, &other.rows)).sqrt().max(1e-300)
    }
}

/// Takes the parts along `columns` out of `rows` (modified Gram–Schmidt, twice for safety).
pub fn project_out(rows: &mut [f64], mut columns: Vec<Vec<f64>>) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let remove = |from: &mut [f64], what: &[f64], share: f64| {
        from.iter_mut().zip(what).for_each(|(f, w)| *f -= share * w);
    };
    for k in 0..columns.len() {
        let (before, rest) = columns.split_at_mut(k);
        let column = &mut rest[0];
        let whole = dot(column, column);
        for _ in 0..2 {
            for basis in before.iter().filter(|b| dot(b, b) > 0.0) {
                let share = dot(column, basis) / dot(basis, basis);
                remove(column, basis, share);
            }
        }
        // A column that the ones before already hold has no direction of its own.
        if dot(column, column) <= 1e-12 * whole {
            column.fill(0.0);
        }
    }
    for basis in &columns {
        let length = dot(basis, basis);
        if length > 0.0 {
            let share = dot(rows, basis) / length;
            remove(rows, basis, share);
        }
    }
}

/// Rows in which the handle is held and moves: elsewhere dry friction is whatever holds it.
pub fn moving(samples: &[Sample], hold_s: [f64; 2]) -> Vec<bool> {
    let inside = |s: &Sample| s.held && s.time_s > hold_s[0] + 0.3 && s.time_s < hold_s[1] - 0.02;
    let held = samples.iter().filter(|s| inside(s));
    let (count, sum) = held.fold((0_usize, 0.0), |(n, sum), s| (n + 1, sum + s.speed * s.speed));
    let least = 0.05 * (sum / count.max(1) as f64).sqrt();
    samples.iter().map(|s| inside(s) && s.speed.abs() > least).collect()
}

fn known_columns(setup: &Setup, known: Known, samples: &[Sample], rows: &[bool]) -> Vec<Vec<f64>> {
    let pick = |f: &dyn Fn(&Sample) -> f64| -> Vec<f64> {
        samples.iter().zip(rows).filter(|(_, use_it)| **use_it).map(|(s, _)| f(s)).collect()
    };
    if setup.center_m.is_some() {
        let mut columns = vec![pick(&|s| s.across_n.abs() * s.speed.signum()), pick(&|s| s.speed)];
        if known == Known::Crank {
            columns.push(pick(&|s| s.angle.cos()));
        }
        return columns;
    }
    let mut columns = vec![pick(&|s| s.acceleration), pick(&|_| 1.0)];
    if known != Known::Mass {
        columns.push(pick(&|s| s.speed));
    }
    if known == Known::MassViscousDry {
        columns.push(pick(&|s| s.speed.signum()));
    }
    columns
}

/// The direction of motion at a sample.
fn along(setup: &Setup, sample: &Sample) -> [f64; 2] {
    if setup.center_m.is_none() {
        return [1.0, 0.0];
    }
    let (sin, cos) = sample.angle.sin_cos();
    [-sin, cos]
}

/// The size of effect `which` in a run.
pub fn size(setup: &Setup, sensor: &Sensor, arm: &Arm, known: Known, samples: &[Sample], which: usize) -> Size {
    let hidden = &setup.hidden[which];
    match hidden.effect.shows() {
        Shows::Force => force_size(setup, sensor, known, samples, which, hidden),
        Shows::Path => path_size(setup, sensor, arm, samples, which),
        Shows::Grossly => Size { rows: vec![1.0], noise: f64::NAN, ..Size::default() },
    }
}

fn force_size(setup: &Setup, sensor: &Sensor, known: Known, samples: &[Sample], which: usize, hidden: &Hidden) -> Size {
    let rows = moving(samples, setup.hold_s);
    let instrument = hidden.effect.is_in_force_sensor();
    let wrong = |s: &Sample| {
        let with = sensor::force(&setup.hidden, None, s, setup.effects_s);
        let without = sensor::force(&setup.hidden, Some(which), s, setup.effects_s);
        [with[0] - without[0], with[1] - without[1]]
    };
    let mut values: Vec<f64> = samples
        .iter()
        .zip(&rows)
        .filter(|(_, use_it)| **use_it)
        .map(|(s, _)| {
            if instrument {
                let (direction, w) = (along(setup, s), wrong(s));
                direction[0] * w[0] + direction[1] * w[1]
            } else if hidden.effect == Effect::GraspCreep {
                turned_n(hidden, s, setup.plant.radius_m)
            } else {
                s.extra_n[which]
            }
        })
        .collect();
    let mut columns = known_columns(setup, known, samples, &rows);
    if hidden.effect == Effect::GraspCreep {
        // A circle is laid through the path: it takes up whatever moves its centre.
        let used = || samples.iter().zip(&rows).filter(|(_, use_it)| **use_it).map(|(s, _)| s);
        columns.push(used().map(|s| s.across_n * s.angle.sin()).collect());
        columns.push(used().map(|s| s.across_n * s.angle.cos()).collect());
    }
    project_out(&mut values, columns);
    // The free finger shows what is wrong with the sensor, and nothing else.
    if instrument && setup.center_m.is_some() {
        for s in samples.iter().filter(|s| !s.held) {
            values.extend(wrong(s));
        }
    }
    let times_s = samples.iter().zip(&rows).filter(|(_, used)| **used).map(|(s, _)| s.time_s).collect();
    Size { rows: values, times_s, noise: sensor.floor_n() }
}

fn path_size(setup: &Setup, sensor: &Sensor, arm: &Arm, samples: &[Sample], which: usize) -> Size {
    let Some(center) = setup.center_m else { return Size::default() };
    let rows = moving(samples, setup.hold_s);
    let others: Vec<Hidden> = setup.hidden.iter().enumerate().filter(|(k, _)| *k != which).map(|(_, h)| *h).collect();
    let radius = |hidden: &[Hidden], s: &Sample| {
        let tip = arm.tip(sensor::joints(arm, hidden, s.tip_m, s.tip_speed).0);
        (tip[0] - center[0]).hypot(tip[1] - center[1])
    };
    // The give of the pad and slips are in the tip already: against the ideal circle. Instruments: against those without.
    let in_tip = matches!(setup.hidden[which].effect, Effect::Pad | Effect::Slip);
    let used: Vec<&Sample> = samples.iter().zip(&rows).filter(|(_, u)| **u).map(|(s, _)| s).collect();
    let mut values: Vec<f64> = used
        .iter()
        .map(|s| {
            if in_tip {
                (s.tip_m[0] - center[0]).hypot(s.tip_m[1] - center[1]) - setup.plant.radius_m
            } else {
                radius(&setup.hidden, s) - radius(&others, s)
            }
        })
        .collect();
    let column = |f: &dyn Fn(&Sample) -> f64| used.iter().map(|s| f(s)).collect::<Vec<f64>>();
    project_out(&mut values, vec![column(&|_| 1.0), column(&|s| s.angle.cos()), column(&|s| s.angle.sin())]);
    // How far the noise of the angles moves the tip outward, on average.
    let mut outward = 0.0;
    for s in &used {
        let (angles, _) = sensor::joints(arm, &[], s.tip_m, [0.0; 2]);
        for (joint, length) in arm.link_m.iter().enumerate() {
            let (sin, cos) = angles[joint].sin_cos();
            outward += (length * (s.angle.sin() * cos - s.angle.cos() * sin)).powi(2);
        }
    }
    let noise = sensor.angle_floor() * (outward / used.len().max(1) as f64).sqrt();
    Size { rows: values, noise, ..Size::default() }
}

/// How well a sum of squares of the known part's own inertia could be seen: its expected log likelihood ratio, doubled.
pub fn visible_inertia(setup: &Setup, sensor: &Sensor, known: Known, samples: &[Sample]) -> f64 {
    let rows = moving(samples, setup.hold_s);
    let mut values: Vec<f64> =
        samples.iter().zip(&rows).filter(|(_, u)| **u).map(|(s, _)| setup.plant.inertia_kg * s.acceleration).collect();
    project_out(&mut values, known_columns(setup, known, samples, &rows));
    values.iter().map(|v| v * v).sum::<f64>() / sensor.floor_n().powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_columns_hold_is_taken_out_and_the_rest_stays() {
        let n = 400;
        let x: Vec<f64> = (0..n).map(|i| f64::from(i) / f64::from(n)).collect();
        let one = vec![1.0; x.len()];
        let mut rows: Vec<f64> = x.iter().map(|x| 3.0 - 2.0 * x + (std::f64::consts::TAU * 8.0 * x).cos()).collect();
        let again = x.iter().map(|x| 2.0 * x + 1.0).collect();
        project_out(&mut rows, vec![one, x.clone(), again]);
        for (x, row) in x.iter().zip(&rows) {
            assert!((row - (std::f64::consts::TAU * 8.0 * x).cos()).abs() < 0.02, "{x} {row}");
        }
    }
}
