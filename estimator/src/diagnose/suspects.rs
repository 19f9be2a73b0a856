//! What could stand behind a diagnosis, one world each: what was found, and every other cause that could have done the same. An
//! experiment can be rehearsed in each of them.

use super::candidate::Candidate;
use super::explain::TWINS;
use super::extend::{effects, effects_of};
use super::force::Model;
use super::geometry::Study;
use super::report::Diagnosis;
use super::track::Track;
use super::world::{calibrated, with_laws};
use super::{Options, blocks, switch};
use crate::estimate::EstimateError;
use haptics::Vec2;
use haptics::law::{EccentricMass, Effect, ForceDrift, GravityTilt, Kind, Law as _, Motion, Weight};
use haptics::recording::Recording;
use haptics::world::World;

/// What a force sensor adds to both axes: a fault of the measurement that the world knows nothing of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorFault {
    /// Always, N.
    pub offset_n: Vec2,
    /// At the start, N/s …
    pub rate_n_s: Vec2,
    /// … and the time in which that settles, s; 0: never.
    pub settles_s: f64,
}

impl SensorFault {
    /// What it adds at a time since the start of a recording, N.
    pub fn at(&self, time_s: f64) -> Vec2 {
        let time = Motion { time_s, ..Motion::default() };
        self.offset_n + self.rate_n_s * Effect::new(&ForceDrift, &[1.0, self.settles_s]).force(&time)
    }

    /// Adds what a candidate of the force came out at; false for a fault that is no force of its own.
    fn add(&mut self, candidate: &Candidate, values: &[f64]) -> bool {
        let both = values.first().zip(values.get(1)).map(|(x, y)| Vec2::new(*x, *y));
        match (candidate.id, both) {
            ("force-bias", Some(offset)) => self.offset_n += offset,
            ("force-drift", Some(rate)) => {
                self.rate_n_s += rate;
                self.settles_s = candidate.searched.first().map_or(0.0, |s| s.value);
            }
            _ => return false,
        }
        true
    }
}

/// One answer that is not excluded, as laws.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Hypothesis {
    /// The cause that is thought to be there.
    id: String,
    /// All laws along the coordinate; nothing where a cause among them has none.
    laws: Option<Vec<Effect>>,
    fault: Option<SensorFault>,
}

/// What could be there, as a world and what its sensors add.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspect {
    /// The cause that is thought to be there.
    pub id: String,
    /// The object with it.
    pub world: World,
    /// What the force sensors add.
    pub fault: SensorFault,
}

/// Everything that could stand in the place of what was found, and what was found itself.
pub(super) fn hypotheses(track: &Track, model: &Model, study: &Study) -> Vec<Hypothesis> {
    let picks = study.picks();
    let mut all = Vec::new();
    for (k, chosen) in study.chosen.iter().enumerate() {
        let own = study.candidates[chosen.candidate].id;
        let mut add = |id: &str, picks: &[usize]| {
            let Some(solved) = study.system.solve(picks) else { return };
            let laws = effects_of(track, model, study, picks, &solved);
            let fault = fault(study, picks, &solved.values);
            all.push(Hypothesis { id: id.to_owned(), laws, fault });
        };
        add(own, &picks);
        for (rival, _) in &chosen.rivals {
            let mut other = picks.clone();
            other[k] = *rival;
            add(study.candidates[*rival].id, &other);
        }
        let twins = TWINS.iter().filter(|(a, b, _)| *a == own && study.candidates.iter().all(|c| c.id != *b));
        for (_, twin, _) in twins.filter(|_| track.planar) {
            let laws = tilted(&effects(track, model, study));
            let fault = study.solved.as_ref().and_then(|s| fault(study, &picks, &s.values));
            all.push(Hypothesis { id: (*twin).to_owned(), laws, fault });
        }
    }
    all
}

/// The faults of the sensors among some candidates; nothing where one of them is no force of its own.
fn fault(study: &Study, picks: &[usize], values: &[f64]) -> Option<SensorFault> {
    let mut sum = SensorFault::default();
    let mut at = study.base.len();
    for candidate in picks.iter().map(|p| &study.candidates[*p]) {
        let end = at + candidate.columns.len();
        if candidate.kind == Kind::Instrument && !sum.add(candidate, &values[at..end]) {
            return None;
        }
        at = end;
    }
    Some(sum)
}

/// The same force by a tilted plane: w cos θ + a sin θ = W cos(θ − δ). Nothing where there is no eccentric mass on a circle.
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

/// Everything that the recordings leave open, as worlds: first what was found. Answers that no world can imitate are left out; so is
/// everything where a fault of the sensors was found that is no force of its own.
pub fn suspects(
    recordings: &[Recording],
    options: &Options,
    diagnosis: &Diagnosis,
) -> Result<Vec<Suspect>, EstimateError> {
    let world = calibrated(recordings, options)?;
    let suspect = |h: &Hypothesis| {
        let mut world = with_laws(&world, h.laws.as_ref()?);
        world.name = format!("{}, with {}", world.name, h.id.replace('-', " "));
        Some(Suspect { id: h.id.clone(), world, fault: h.fault? })
    };
    let mut found: Vec<Suspect> = Vec::new();
    for suspect in diagnosis.hypotheses.iter().filter_map(suspect) {
        if found.iter().all(|s| s.id != suspect.id) {
            found.push(suspect);
        }
    }
    if found.is_empty() && world.crank.is_none() && world.mechanism.is_none() {
        let mut world = world;
        blocks::extend(&mut world, diagnosis);
        switch::extend(&mut world, diagnosis);
        found.extend(diagnosis.causes.first().map(|c| Suspect {
            id: c.id.clone(),
            world,
            fault: SensorFault::default(),
        }));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
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
    fn a_drift_grows_and_an_offset_stays() {
        let fault = SensorFault { offset_n: Vec2::new(0.1, 0.0), rate_n_s: Vec2::new(0.0, 0.02), settles_s: 0.0 };
        assert!((fault.at(10.0) - Vec2::new(0.1, 0.2)).norm() < 1e-12);
        let settling = SensorFault { settles_s: 5.0, ..fault };
        assert!((settling.at(1e3).y - 0.1).abs() < 1e-9, "{:?}", settling.at(1e3));
    }
}
