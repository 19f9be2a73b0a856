//! Hypothetical worlds behind a diagnosis: one with the causes found, and one for each rival that explains the data as
//! well. Experiments can be rehearsed in each.

use super::model::{effects, effects_of};
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::hypotheses::all::{add_to_fault, twins};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::sensor_fault::SensorFault;
use crate::diagnose::selection::comparison::ChannelFit;
use haptics::law::{EccentricMass, Effect, GravityTilt, Kind, Law as _, Weight};

/// Effects in the object, in the form that its task uses.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Inside {
    /// All laws along the coordinate.
    Laws(Vec<Effect>),
    /// Effects on blocks: causes with their parameters.
    Acts(Vec<Act>),
}

/// A cause that acts on blocks, with its estimated parameters.
pub(crate) type Act = (String, Vec<CauseParameter>);

/// One answer that is not excluded.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Hypothesis {
    pub(crate) id: String,
    /// `None` if a cause among them cannot be simulated.
    pub(crate) inside: Option<Inside>,
    pub(crate) fault: Option<SensorFault>,
    pub(crate) hung_share: f64,
}

/// Tilt of an axis that is assumed to be vertical, as a sine: no recording of the mechanism alone shows it. Nobody
/// notices some six degrees.
/// Choice: no case of the ablation reads it.
const LEANS: f64 = 0.1;

/// The hypothesis as found, and those of every rival cause.
pub(crate) fn hypotheses(track: &Track, model: &Model, study: &ChannelFit) -> Vec<Hypothesis> {
    let picks = study.picks();
    let mut all = Vec::new();
    for (k, chosen) in study.chosen.iter().enumerate() {
        let own = study.candidates[chosen.candidate].id;
        let mut add = |id: &str, picks: &[usize]| {
            let Some(solved) = study.system.solve(picks) else { return };
            let inside = effects_of(track, model, study, picks, &solved).map(Inside::Laws);
            let fault = add_faults(&SensorFault::default(), study, picks, &solved.values);
            all.push(Hypothesis { id: id.to_owned(), inside, fault, hung_share: 1.0 });
        };
        add(own, &picks);
        for (rival, _) in &chosen.rivals {
            let mut other = picks.clone();
            other[k] = *rival;
            add(study.candidates[*rival].id, &other);
        }
        let twins = twins().filter(|(a, b, _)| *a == own && study.candidates.iter().all(|c| c.id != *b));
        for (_, twin, _) in twins {
            let laws = effects(track, model, study);
            // By itself, a tilted axis is equivalent to an eccentric mass. Only a hung weight separates them.
            let (laws, hung_share) = if track.planar { (tilted(&laws), 1.0) } else { (Some(laws), LEANS) };
            let fault =
                study.solved.as_ref().and_then(|s| add_faults(&SensorFault::default(), study, &picks, &s.values));
            all.push(Hypothesis { id: twin.to_owned(), inside: laws.map(Inside::Laws), fault, hung_share });
        }
    }
    all
}

/// Translation of a channel's causes into effects of a world.
pub(crate) trait Simulated {
    /// Estimates of the base model itself: weights.
    fn base(&self, _values: &[f64]) -> Vec<Act> {
        Vec::new()
    }
    /// A cause with its parameters for a world; `None` if the world has no such effect.
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act>;
    /// True if a fault begins only when something is held.
    fn is_late(&self, _candidate: &Candidate) -> bool {
        false
    }
    /// The fault in the axes of the sensors.
    fn fault(&self, fault: &SensorFault) -> SensorFault {
        *fault
    }
}

/// The same for objects without laws along one coordinate: each question of each channel, the others answered as found.
pub(crate) fn of_channels(channels: &[(&ChannelFit, &dyn Simulated)]) -> Vec<Hypothesis> {
    let found: Vec<Vec<usize>> = channels.iter().map(|(study, _)| study.picks()).collect();
    let mut all = Vec::new();
    for (c, (study, _)) in channels.iter().enumerate() {
        for (k, chosen) in study.chosen.iter().enumerate() {
            for candidate in std::iter::once(chosen.candidate).chain(chosen.rivals.iter().map(|(rival, _)| *rival)) {
                let mut picks = found.clone();
                picks[c][k] = candidate;
                let id = study.candidates[candidate].id.to_owned();
                all.extend(of_picks(channels, &picks).map(|(acts, fault)| Hypothesis {
                    id,
                    inside: acts.map(Inside::Acts),
                    fault,
                    hung_share: 1.0,
                }));
            }
        }
    }
    all
}

/// Acts and faults of some candidates of each channel; `None` if they cannot be solved.
fn of_picks(
    channels: &[(&ChannelFit, &dyn Simulated)],
    picks: &[Vec<usize>],
) -> Option<(Option<Vec<Act>>, Option<SensorFault>)> {
    let (mut acts, mut sum) = (Some(Vec::new()), Some(SensorFault::default()));
    for ((study, channel), picks) in channels.iter().zip(picks) {
        let solved = study.system.solve(picks)?;
        let mut own = channel.base(&solved.values[..study.baseline.len()]);
        for (candidate, values) in study.with_values(picks, &solved.values) {
            match channel.act(candidate, values) {
                _ if candidate.kind != Kind::Plant => {}
                Some(act) => own.push(act),
                None => acts = None,
            }
        }
        if let Some(acts) = &mut acts {
            acts.append(&mut own);
        }
        sum = sum.and_then(|sum| add_faults(&sum, study, picks, &solved.values));
        if let Some(sum) = &mut sum {
            sum.drifts_once_held |= picks.iter().any(|p| channel.is_late(&study.candidates[*p]));
        }
    }
    let as_sensed = |sum| channels.first().map_or(sum, |(_, channel)| channel.fault(&sum));
    Some((acts, sum.map(as_sensed)))
}

/// The fault of the force sensors that a comparison found, if it found one that can be added to a recording.
pub(crate) fn found_fault(study: &ChannelFit) -> Option<SensorFault> {
    let values = &study.solved.as_ref()?.values;
    add_faults(&SensorFault::default(), study, &study.picks(), values).filter(|fault| *fault != SensorFault::default())
}

/// The sensor faults among some candidates, added to other faults; `None` if one of them cannot be added to a recording.
fn add_faults(beside: &SensorFault, study: &ChannelFit, picks: &[usize], values: &[f64]) -> Option<SensorFault> {
    let mut sum = *beside;
    let mut faults = study.with_values(picks, values).filter(|(c, _)| c.kind == Kind::Instrument);
    faults.all(|(fault, values)| add_to_fault(&mut sum, fault, values)).then_some(sum)
}

/// Equivalent force of a tilted plane: w cos θ + a sin θ = W cos(θ − δ). `None` without an eccentric mass on a circle.
fn tilted(laws: &[Effect]) -> Option<Vec<Effect>> {
    let mass = laws.iter().find(|e| e.law().id() == EccentricMass.id())?;
    let [sine_n, cosine_n, radius_m, ..] = mass.values;
    let is_weight = |e: &&Effect| e.law().id() == Weight.id();
    let level_n = cosine_n + laws.iter().filter(is_weight).map(|e| e.values[0]).sum::<f64>();
    let weight_n = level_n.hypot(sine_n);
    let others = laws.iter().filter(|e| !is_weight(e) && e.law().id() != EccentricMass.id()).copied();
    let tilt = Effect::new(&GravityTilt, &[weight_n, sine_n.atan2(level_n), radius_m]);
    Some(others.chain([Effect::new(&Weight, &[weight_n]), tilt]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypotheses::sensor_fault::Step;
    use haptics::Vec2;
    use haptics::law::Motion;
    use haptics::law::ViscousFriction;

    fn force(laws: &[Effect], angle_rad: f64, radius_m: f64) -> f64 {
        let motion = Motion {
            position: angle_rad * radius_m,
            velocity: 0.1,
            direction: 1.0,
            up_along: angle_rad.cos(),
            ..Motion::default()
        };
        laws.iter().map(|e| e.force(&motion)).sum()
    }

    #[test]
    fn a_tilt_makes_the_same_force_as_the_eccentric_mass_it_stands_for_until_a_weight_is_hung_on() {
        let radius_m = 0.03;
        let laws = [
            Effect::new(&Weight, &[0.3]),
            Effect::new(&ViscousFriction, &[2.0]),
            Effect::new(&EccentricMass, &[0.12, 0.0, radius_m]),
        ];
        let tilted = tilted(&laws).expect("an eccentric mass");
        for k in 0..40 {
            let angle = 0.3 * f64::from(k) - 3.0;
            let apart = force(&laws, angle, radius_m) - force(&tilted, angle, radius_m);
            assert!(apart.abs() < 1e-12, "at {angle} rad they are {apart} N apart");
        }
        assert!(super::tilted(&laws[..2]).is_none());
    }

    #[test]
    fn faults_are_each_fingers_own_or_halved_between_them_or_those_of_one_coordinate() {
        let column = || vec![1.0];
        let mut fault = SensorFault::default();
        let net = vec![("bx", "N"), ("by", "N")];
        let net = Candidate::several("force-bias", Kind::Instrument, vec![column(), column()], net);
        assert!(add_to_fault(&mut fault, &net, &[0.2, -0.4]));
        let one =
            |id, name| Candidate::several(id, Kind::Instrument, vec![column()], vec![(name, "1")]).at("tau", 5.0, "s");
        for (id, name, value) in [
            ("force-bias", "by2", 0.1),
            ("force-drift", "ry1", 0.02),
            ("force-cross-axis", "kappa_yx1", 0.1),
            ("force-cross-axis", "kappa_xy", -0.3),
            ("force-gain", "g - 1", 0.05),
            ("time-delay", "tau", 0.01),
            ("force-bias", "b", 0.7),
            ("force-drift", "rate", 0.03),
            ("force-step", "by", 0.4),
        ] {
            assert!(add_to_fault(&mut fault, &one(id, name), &[value]), "{id} {name}");
        }
        let expected = SensorFault {
            offset_n: [Vec2::new(0.1, -0.2), Vec2::new(0.1, -0.1)],
            drift_n_s: [Vec2::new(0.0, 0.02), Vec2::zeros()],
            settles_s: 5.0,
            drifts_once_held: false,
            offset_along: 0.7,
            drift_along_per_s: 0.03,
            steps: [
                Step { at_s: 5.0, force_n: [Vec2::new(0.0, 0.2); 2], along: 0.0 },
                Step::default(),
                Step::default(),
            ],
            cross: [Vec2::new(-0.3, 0.1), Vec2::new(-0.3, 0.0)],
            gain_error: 0.05,
            delay_s: 0.01,
        };
        assert_eq!(fault, expected);
        assert!(!add_to_fault(&mut fault, &one("length-scale", "epsilon"), &[0.1]), "no fault of a force");
    }
}
