//! A recording, and apart from it what is hidden in it.

use super::arm::Arm;
use super::chance::Chance;
use super::draw::{self, Bench, Spec};
use super::effect::{Effect, Shows};
use super::interval::Share;
use super::measure::{self, Known, Size};
use super::perform::perform;
use super::plan::Log;
use super::plant::Hidden;
use super::record::{clock, record};
use super::sensor::{self, Sensor};
use super::simulate::{Sample, Setup};
use super::structure;
use estimator::diagnose::Experiment;
use haptics::recording::Recording;

/// What may be looked at.
#[derive(Clone, Debug)]
pub struct Case {
    /// The recordings of one object.
    pub recordings: Vec<Recording>,
    /// The model of a mechanism to start from; nothing for a crank.
    pub baseline: Option<&'static str>,
    /// Repeats the case.
    pub seed: u64,
    /// What is moved.
    pub bench: Bench,
    /// How.
    pub log: Log,
    /// Samples a second.
    pub rate_hz: f64,
}

/// What only a scorer opens.
#[derive(Clone, Debug)]
pub struct Truth {
    /// What is hidden; empty in a null case.
    pub hidden: Vec<Hidden>,
    /// Effect over noise that was asked for, for each.
    pub wanted_ratio: Vec<f64>,
    /// Effect over noise that came out, for each.
    pub ratio: Vec<f64>,
    /// What each leaves after the known model took what it can: root mean square, N (m for effects on the path).
    pub effect_rms: Vec<f64>,
    /// The first effect's force over time (s, N), after the known model took what it can; empty where it has none.
    pub effect: Vec<(f64, f64)>,
    /// Noise of the force along the motion, N.
    pub noise_n: f64,
    /// Noise of an angle (of a mechanism's coordinate), rad or m.
    pub angle_noise: f64,
    /// Causes that this recording cannot tell from a hidden one, even without noise.
    pub equals: Vec<&'static str>,
    /// Expected likelihood ratio (doubled logarithm) of the crank's own small inertia: below one.
    pub visible_inertia: f64,
    /// Correlation of two hidden effects in the rows where both show.
    pub correlation: f64,
    /// The oracle: the force that the instruments would tell without noise, sample by sample, N.
    pub noise_free_n: Vec<[f64; 2]>,
    /// Samples in which the hand holds on.
    pub held: Vec<bool>,
}

impl Truth {
    /// The ids of what is hidden.
    pub fn ids(&self) -> Vec<&'static str> {
        self.hidden.iter().map(|h| h.effect.id()).collect()
    }

    /// True when a size was asked for and could not be had.
    pub fn missed(&self) -> bool {
        let off = |(r, wanted): (&f64, &f64)| r.is_finite() && (r / wanted - 1.0).abs() > 0.1;
        self.ratio.iter().zip(&self.wanted_ratio).any(off)
    }
}

/// A case as asked for.
pub fn make(spec: &Spec, seed: u64) -> (Case, Truth) {
    make_followed(spec, &[], seed)
}

/// The same, with further recordings of the same object by the same hand, moved in other ways: what settles an ambiguity. Sizes are
/// beside the noise of the first recording, and the truth's samples are those of the first.
pub fn make_followed(spec: &Spec, then: &[Log], seed: u64) -> (Case, Truth) {
    let (case, truth, _) = make_with_object(spec, then, seed);
    (case, truth)
}

/// What was recorded: who asks for another motion of it gets the same object, hand and instruments.
#[derive(Clone, Debug)]
pub struct Object {
    spec: Spec,
    setup: Setup,
    sensor: Sensor,
    arm: Arm,
    zero_m: Option<f64>,
}

impl Object {
    /// The answered experiment on the same object, with fresh noise; nothing where nobody knows how it is done.
    pub fn perform(&self, asked: &Experiment, seed: u64) -> Option<Recording> {
        let mut chance = Chance::new(seed, 5);
        let setup = perform(&self.spec, &self.setup, asked, self.zero_m.unwrap_or(0.0), seed)?;
        let spec = Spec { seconds: setup.seconds, ..self.spec.clone() };
        let samples = setup.run();
        let mut zero_m = self.zero_m;
        Some(record(&spec, &setup, &self.sensor, &self.arm, &samples, &mut chance, &mut zero_m))
    }
}

/// The same, and the object.
pub fn make_with_object(spec: &Spec, then: &[Log], seed: u64) -> (Case, Truth, Object) {
    let mut chance = Chance::new(seed, 3);
    let arm = draw::arm(&mut chance);
    let mut sensor = draw::sensor(spec, &mut chance);
    let mut setup = draw::setup(spec, &sensor, &arm, seed);
    let known = draw::known(spec);
    let mut samples = calm(&mut setup, &sensor, known);
    let wanted = spec.wanted_ratios();
    scale(&mut setup, &sensor, &arm, known, &wanted, &mut samples);
    tune_noise(&setup, &mut sensor, &arm, known, &wanted, &samples);
    let sizes: Vec<Size> =
        (0..setup.hidden.len()).map(|k| measure::size(&setup, &sensor, &arm, known, &samples, k)).collect();
    let mut zero_m = None;
    let mut recordings = vec![record(spec, &setup, &sensor, &arm, &samples, &mut chance, &mut zero_m)];
    for (k, log) in then.iter().enumerate() {
        let again = Spec { log: *log, ..spec.clone() };
        let mut next = draw::setup(&again, &sensor, &arm, seed.wrapping_add(7_777_777 * (k as u64 + 1)));
        (next.plant, next.center_m) = (setup.plant, setup.center_m);
        next.hidden.clone_from(&setup.hidden);
        let samples = next.run();
        recordings.push(record(&again, &next, &sensor, &arm, &samples, &mut chance, &mut zero_m));
    }
    let truth = Truth {
        wanted_ratio: wanted,
        ratio: sizes.iter().map(Size::ratio).collect(),
        effect_rms: sizes.iter().map(Size::rms).collect(),
        effect: sizes
            .first()
            .map_or_else(Vec::new, |s| s.times_s.iter().copied().zip(s.rows.iter().copied()).collect()),
        noise_n: sensor.floor_n(),
        angle_noise: sensor.angle_floor(),
        equals: equals(spec, &setup, &samples),
        visible_inertia: if setup.center_m.is_some() {
            measure::visible_inertia(&setup, &sensor, known, &samples)
        } else {
            0.0
        },
        correlation: if sizes.len() > 1 { sizes[0].correlation(&sizes[1]) } else { 0.0 },
        noise_free_n: clock(&setup)
            .read(&samples)
            .iter()
            .map(|s| sensor::force(&setup.hidden, None, s, setup.effects_s))
            .collect(),
        held: samples.iter().map(|s| s.held).collect(),
        hidden: setup.hidden.clone(),
    };
    let baseline = match known {
        Known::Crank | Known::CrankOfKnownWeight => None,
        Known::Mass => Some("mass"),
        Known::MassViscous => Some("mass+viscous"),
        Known::MassViscousDry => Some("mass+viscous+coulomb"),
    };
    let case = Case { recordings, baseline, seed, bench: spec.bench, log: spec.log, rate_hz: spec.rate_hz };
    (case, truth, Object { spec: spec.clone(), setup, sensor, arm, zero_m })
}

/// The first run, with the crank's own inertia so small that nobody could see it in this noise.
fn calm(setup: &mut Setup, sensor: &Sensor, known: Known) -> Vec<Sample> {
    let samples = setup.run();
    if setup.center_m.is_some() {
        let visible = measure::visible_inertia(setup, sensor, known, &samples);
        if visible > 0.5 {
            setup.plant.inertia_kg = (setup.plant.inertia_kg * (0.2 / visible).sqrt()).max(1e-6);
            return setup.run();
        }
    }
    samples
}

/// Scales what is hidden to its wanted size beside the noise: measure, rescale, simulate again.
fn scale(setup: &mut Setup, sensor: &Sensor, arm: &Arm, known: Known, wanted: &[f64], samples: &mut Vec<Sample>) {
    let peak = samples.iter().flat_map(|s| s.force_n).fold(0.0_f64, |m, f| m.max(f.abs()));
    for hidden in setup.hidden.iter_mut().filter(|h| h.effect == Effect::Saturation) {
        hidden.shape[1] = peak;
    }
    let mut last: Vec<Option<(f64, f64)>> = vec![None; setup.hidden.len()];
    for _ in 0..5 {
        let mut far = false;
        for (k, (last, &ratio)) in last.iter_mut().zip(wanted).enumerate() {
            if setup.hidden[k].effect.shows() == Shows::Grossly {
                continue;
            }
            let now = measure::size(setup, sensor, arm, known, samples, k).ratio();
            let size = setup.hidden[k].size;
            // The noise takes the rest when there is one effect only.
            far |= (now / ratio - 1.0).abs() > if setup.hidden.len() == 1 { 0.2 } else { 0.03 };
            // How the ratio grows with the size: proportionally, until two sizes were tried.
            let power = last.map_or(1.0, |(s, r): (f64, f64)| {
                let slope = (now / r).ln() / (size / s).ln();
                if slope.is_finite() { slope.clamp(0.35, 2.5) } else { 1.0 }
            });
            let factor = (ratio / now.max(1e-9)).powf(1.0 / power).clamp(0.05, 20.0);
            *last = Some((size, now));
            setup.hidden[k].size = limited(setup, k, size * factor);
        }
        if !far {
            for (hidden, tried) in setup.hidden.iter_mut().zip(&last) {
                if let Some((size, _)) = tried {
                    hidden.size = *size;
                }
            }
            return;
        }
        if setup.hidden.iter().any(|h| h.effect.acts_on_motion()) {
            *samples = setup.run();
        }
    }
}

/// Sizes beyond which an effect would be another thing.
fn limited(setup: &Setup, which: usize, size: f64) -> f64 {
    match setup.hidden[which].effect {
        Effect::Backlash => size.clamp(1e-5, 0.25 * setup.plant.radius_m),
        Effect::Hysteresis => size.clamp(1e-5 * setup.plant.radius_m, setup.plant.radius_m),
        Effect::Delay => size.clamp(1e-4, 0.1),
        // A person must still be able to break it loose.
        Effect::Stribeck if setup.center_m.is_some() => size.min(0.4),
        Effect::Stribeck => size.min(2.0 * setup.plant.dry_n),
        Effect::Tilt => size.clamp(-0.7, 0.7),
        Effect::Leak => size.clamp(-0.9, 0.9),
        Effect::Gain | Effect::CrossAxis => size.clamp(-0.6, 0.6),
        effect if effect.is_structure() => structure::limited(setup, &setup.hidden[which], size),
        _ => size,
    }
}

/// The last per cent: one effect alone gets exactly its ratio by a slightly better or worse instrument.
fn tune_noise(setup: &Setup, sensor: &mut Sensor, arm: &Arm, known: Known, wanted: &[f64], samples: &[Sample]) {
    let ([hidden], [ratio]) = (setup.hidden.as_slice(), wanted) else { return };
    let now = measure::size(setup, sensor, arm, known, samples, 0).ratio() / ratio;
    let least = if hidden.effect.is_structure() { 0.25 } else { 0.4 };
    if !(least..2.0).contains(&now) {
        return;
    }
    match hidden.effect.shows() {
        Shows::Force => {
            sensor.noise_n *= now;
            sensor.step_n *= now;
        }
        Shows::Path => {
            sensor.angle_noise *= now;
            sensor.angle_step *= now;
        }
        Shows::Grossly => {}
    }
}

/// Causes whose every trace is the same in this recording.
fn equals(spec: &Spec, setup: &Setup, samples: &[Sample]) -> Vec<&'static str> {
    let mut equal = Vec::new();
    let moving = measure::moving(samples, setup.hold_s);
    let pulls = samples.iter().zip(&moving).filter(|(_, moving)| **moving).map(|(s, _)| s.across_n > 0.0);
    let outward = Share::count(pulls, |outward| outward).value();
    let pulls_one_way = !(0.005..0.995).contains(&outward);
    let lets_go = setup.hold_s[1] < setup.seconds - 0.5;
    for hidden in &setup.hidden {
        match hidden.effect {
            // Both turn the handle by a sine of its angle.
            Effect::Eccentric if spec.bench.is_crank() => equal.push(Effect::Tilt.id()),
            Effect::Tilt => equal.push(Effect::Eccentric.id()),
            // A turned sensor mixes the load in with its sign, and that never changes.
            Effect::Asymmetry if pulls_one_way && hidden.form == 0 && spec.bench.is_crank() => {
                equal.push(Effect::CrossAxis.id());
            }
            // A weight that changes in time is a vertical drift, unless the finger is free again in the end.
            Effect::Leak if !lets_go => equal.push(Effect::Drift.id()),
            Effect::Coulomb if !spec.log.reverses() => equal.push(Effect::Asymmetry.id()),
            Effect::Asymmetry if !spec.log.reverses() && hidden.form == 2 => equal.push(Effect::Coulomb.id()),
            _ => {}
        }
    }
    equal
}
