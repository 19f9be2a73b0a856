//! Extended model: the base model with the causes found, as laws with values that a world can run.

use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::hypotheses::candidate::{Candidate, about_its_zero};
use crate::diagnose::hypotheses::{free_motion, slope};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::normal_equations::Solved;
use crate::diagnose::selection::profile_likelihood::{settled, shares};
use haptics::law::{
    AddedConstraint, Backlash, Cable, CoulombFriction, EccentricMass, Effect, FrictionAsymmetry, FrictionChange,
    GravityTilt, Hysteresis, Inertia, Kind, Law, LoadFriction, LoadFrictionChange, LoadHysteresis, LocalPush,
    LocalResistance, MassChange, Motion, PositionRipple, QuadraticDrag, ReturnSpring, Role, Stribeck, ViscousFriction,
};

/// The model's laws refitted beside the chosen causes, and the plant causes among these as laws of their own.
/// Instruments' faults are no part of a world.
pub fn effects(track: &Track, model: &Model, study: &ChannelFit) -> Vec<Effect> {
    let Some(settled) = settled(study) else { return model.clone() };
    let searched: Vec<Vec<f64>> =
        settled.searched.iter().map(|all| all.iter().map(|known| known.value).collect()).collect();
    let candidates: Vec<&Candidate> = study.picks().into_iter().map(|c| &study.candidates[c]).collect();
    made(track, model, &candidates, &settled.values, &searched).0
}

/// The same for some of the candidates; `None` if a plant cause among them has no law in a world.
pub fn effects_of(
    track: &Track,
    model: &Model,
    study: &ChannelFit,
    picks: &[usize],
    solved: &Solved,
) -> Option<Vec<Effect>> {
    let candidates: Vec<&Candidate> = picks.iter().map(|c| &study.candidates[*c]).collect();
    let tried = |c: &&Candidate| c.searched.iter().map(|s| s.value).collect();
    let searched: Vec<Vec<f64>> = candidates.iter().map(tried).collect();
    let mut values = solved.values.clone();
    shares(study, picks).for_each(|first| values[first] *= study.shares_of[0]);
    let (found, is_whole) = made(track, model, &candidates, &values, &searched);
    is_whole.then_some(found)
}

/// The laws, and true if every plant cause is among them. `values`: of the model's regressors, then of the causes'
/// ones; `searched`: searched values of each cause.
fn made(
    track: &Track,
    model: &Model,
    causes: &[&Candidate],
    values: &[f64],
    searched: &[Vec<f64>],
) -> (Vec<Effect>, bool) {
    let found: Vec<Effect> = model.iter().zip(values).map(|(e, share)| scaled(e, *share)).collect();
    let of_causes = causes.iter().map(|c| c.columns.len()).sum::<usize>();
    let dry = Dry::of(&found);
    beside_model(track, found, &dry, causes, &values[values.len() - of_causes..], searched)
}

/// Laws of causes found beside a model without dry friction of its own. Dry friction must precede the causes that are a
/// share of it. `None` if a cause has no law. `dry_n`: friction to which the shares refer, N; `values`: of the causes
/// alone.
pub fn without_friction(
    track: &Track,
    laws: Vec<Effect>,
    dry_n: f64,
    causes: &[&Candidate],
    values: &[f64],
) -> Option<Vec<Effect>> {
    let tried = |c: &&Candidate| c.searched.iter().map(|s| s.value).collect();
    let searched: Vec<Vec<f64>> = causes.iter().map(tried).collect();
    let (found, is_whole) = beside_model(track, laws, &Dry { level_n: dry_n, mu: 0.0 }, causes, values, &searched);
    is_whole.then_some(found)
}

fn beside_model(
    track: &Track,
    mut found: Vec<Effect>,
    dry: &Dry,
    causes: &[&Candidate],
    values: &[f64],
    searched: &[Vec<f64>],
) -> (Vec<Effect>, bool) {
    let weight_n = found.iter().filter(|e| e.role() == Role::Gravity).map(|e| e.values[0]).sum::<f64>();
    let (mut at, mut is_whole) = (0, true);
    for (candidate, searched) in causes.iter().zip(searched) {
        let values = &values[at..at + candidate.columns.len()];
        if candidate.id == Hysteresis.id() {
            // Friction that bends before it slides is part of the dry friction, and is subtracted from it.
            found.iter_mut().filter(|e| e.law().is_dry()).for_each(|e| *e = scaled(e, (1.0 - values[0]).max(0.0)));
        }
        let laws = match dry.law(candidate, values, searched) {
            laws if laws.is_empty() => effect(candidate, (values, searched), track, weight_n).into_iter().collect(),
            laws => laws,
        };
        is_whole &= !laws.is_empty() || candidate.kind == Kind::Instrument;
        found.extend(laws);
        at += candidate.columns.len();
    }
    (free_motion::whole(track, found), is_whole)
}

/// Dry friction of a model: a constant part, N or N m, and a part in proportion to the load.
struct Dry {
    level_n: f64,
    mu: f64,
}

impl Dry {
    fn of(laws: &[Effect]) -> Self {
        let at = |normal_force_n: f64| {
            let motion = Motion { direction: 1.0, normal_force_n, ..Motion::default() };
            laws.iter().filter(|e| e.law().is_dry()).map(|e| e.force(&motion)).sum::<f64>()
        };
        Self { level_n: at(0.0).max(0.0), mu: (at(1.0) - at(0.0)).max(0.0) }
    }

    /// Laws of a cause that is a share of the dry friction, one for each part of that friction. Empty for other causes.
    fn law(&self, candidate: &Candidate, values: &[f64], searched: &[f64]) -> Vec<Effect> {
        let (share, searched) = (values[0], |k: usize| searched.get(k).copied().unwrap_or(0.0));
        let starts = candidate.searched.first().is_some_and(|s| s.name == "t0");
        let course = if starts { [0.0, searched(0)] } else { [searched(0), 0.0] };
        let changes = |of: f64| [0.0, share * of, course[0], course[1]];
        let (level, mu) = match candidate.id {
            "hysteresis" => {
                let (level, way) = (share * self.level_n, searched(0).max(1e-12));
                let everywhere = Effect::new(&Hysteresis, &[level, level / way, searched(1)]);
                (everywhere, Effect::new(&LoadHysteresis, &[share * self.mu, way, searched(1)]))
            }
            // No law of a world depends on other recorded channels.
            "friction-change" if candidate.channel.is_none() => (
                Effect::new(&FrictionChange, &changes(self.level_n)),
                Effect::new(&LoadFrictionChange, &changes(self.mu)),
            ),
            _ => return Vec::new(),
        };
        let parts = [(level, self.level_n), (mu, self.mu)];
        parts.into_iter().filter(|(_, size)| *size > 0.0).map(|(law, _)| law).collect()
    }
}

/// The model's laws fitted without any cause.
pub fn plain(track: &Track, model: &Model, study: &ChannelFit) -> Vec<Effect> {
    let Some(solved) = study.system.solve(&[]) else { return model.clone() };
    free_motion::whole(track, model.iter().zip(&solved.values).map(|(e, share)| scaled(e, *share)).collect())
}

/// A law whose linear parameters all change by one factor.
fn scaled(effect: &Effect, share: f64) -> Effect {
    let mut scaled = *effect;
    for (value, spec) in scaled.values.iter_mut().zip(effect.law().parameters()) {
        if spec.enters == haptics::law::Enters::Linear {
            *value *= share;
        }
    }
    scaled
}

/// Law of a plant cause that is no share of the dry friction. `weight_n`: weight of the model, N or N m.
fn effect(candidate: &Candidate, (values, searched): (&[f64], &[f64]), track: &Track, weight_n: f64) -> Option<Effect> {
    if candidate.kind != Kind::Plant {
        return None;
    }
    let first = values.first().copied().unwrap_or(0.0);
    let searched = |k: usize| searched.get(k).copied().unwrap_or(0.0);
    let radius = track.radius_m.unwrap_or(0.0);
    let named = |name: &str| candidate.linear.first().is_some_and(|(n, _)| *n == name);
    let of = |law: &'static dyn Law, values: &[f64]| Some(Effect::new(law, values));
    match candidate.id {
        "coulomb-friction" => of(&CoulombFriction, &[first]),
        "load-friction" => of(&LoadFriction, &[first]),
        "viscous-friction" => of(&ViscousFriction, &[first]),
        "friction-asymmetry" if named("dFc") => of(&FrictionAsymmetry, &[first, 0.0, 0.0]),
        "friction-asymmetry" if named("dc") => of(&FrictionAsymmetry, &[0.0, first, 0.0]),
        "friction-asymmetry" => of(&FrictionAsymmetry, &[0.0, 0.0, first]),
        "stribeck" => of(&Stribeck, &[first, searched(0), searched(1)]),
        "quadratic-drag" => of(&QuadraticDrag, &[first]),
        "inertia" => of(&Inertia, &[first]),
        "eccentric-mass" => of(&EccentricMass, &[first, values.get(1).copied().unwrap_or(0.0), radius]),
        "gravity-tilt" if track.planar && weight_n > 0.0 => of(&GravityTilt, &[weight_n, first, radius]),
        "gravity-tilt" => slope::tilted(track, first),
        "position-ripple" => {
            let (cosine, sine) = (first, values.get(1).copied().unwrap_or(0.0));
            // cos(x − π/2) is the regressor of the sine.
            of(&PositionRipple, &[cosine.hypot(sine), searched(0), (-sine).atan2(cosine)])
        }
        "return-spring" if named("k3") => of(&ReturnSpring, &[0.0, 0.0, first, searched(0)]),
        "return-spring" if !candidate.searched.is_empty() => {
            of(&ReturnSpring, &[first, 0.0, values.get(1).copied().unwrap_or(0.0), searched(0)])
        }
        "return-spring" => of(&ReturnSpring, &spring(values, track)),
        "local-resistance" => {
            let turn = if radius > 0.0 { std::f64::consts::TAU * radius } else { 0.0 };
            let values = [first, searched(0), searched(1), turn];
            if named("P") { of(&LocalPush, &values) } else { of(&LocalResistance, &values) }
        }
        "added-constraint" if candidate.searched.len() == 3 => {
            of(&Cable, &[first, searched(1), searched(0), searched(2), radius])
        }
        "added-constraint" => of(&AddedConstraint, &[first, searched(0), candidate.side]),
        "backlash" => of(&Backlash, &[searched(0)]),
        "mass-change" if named("rate") => of(&MassChange, &[0.0, first, 0.0, 0.0, searched(0)]),
        "mass-change" => {
            // A step takes place within a sample.
            let step_s = track.period_s;
            of(&MassChange, &[0.0, first / step_s, searched(0), step_s])
        }
        _ => None,
    }
}

/// Parameters of a spring, k, f0, k3 and rest position, from the coefficients of its regressors.
pub fn spring(values: &[f64], track: &Track) -> [f64; 4] {
    let (low, high) = (track.quantile(0.0, |r| r.motion.position), track.quantile(1.0, |r| r.motion.position));
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low).max(1e-12));
    let cube = half.powi(3);
    let at = |k: usize| values.get(k).copied().unwrap_or(0.0);
    let [k, f0, k3, place] = about_its_zero([at(0) * half, at(1), at(2) * cube, at(3) * cube]);
    [k / half, f0, k3 / cube, middle + place * half]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_friction_that_goes_with_the_load_goes_with_it() {
        let model = [
            Effect::new(&CoulombFriction, &[0.1]),
            Effect::new(&LoadFriction, &[0.2]),
            Effect::new(&ViscousFriction, &[3.0]),
        ];
        let at = |time_s: f64| Motion { time_s, direction: 1.0, normal_force_n: -5.0, ..Motion::default() };
        let total = |laws: &[Effect], time_s: f64| laws.iter().map(|e| e.force(&at(time_s))).sum::<f64>();
        let bends = Candidate::one("hysteresis", Kind::Plant, "share", "1", Vec::new()).at("way", 1e-4, "m");
        let laws = Dry::of(&model).law(&bends, &[0.8], &[1e-4]);
        assert!(laws.len() == 2 && (total(&laws, 0.0) - 0.8 * (0.1 + 0.2 * 5.0)).abs() < 1e-12, "{laws:?}");
        // The same share under another load.
        let loaded = Dry::of(&model[1..2]).law(&bends, &[0.8], &[1e-4]);
        assert!(loaded.len() == 1 && (total(&loaded, 0.0) - 0.8).abs() < 1e-12, "{loaded:?}");
        let change = || Candidate::one("friction-change", Kind::Plant, "relative change", "1", Vec::new());
        let laws = Dry::of(&model).law(&change().at("t0", 8.0, "s"), &[0.5], &[8.0]);
        assert!(total(&laws, 7.9) == 0.0 && (total(&laws, 8.1) - 0.5 * 1.1).abs() < 1e-12, "{laws:?}");
        let warms = Dry::of(&model).law(&change().at("tau", 8.0, "s"), &[-0.5], &[8.0]);
        assert!((total(&warms, 8.0) + 0.5 * 1.1 * (1.0 - (-1.0_f64).exp())).abs() < 1e-12, "{warms:?}");
        let channel = ("temperature_degC".to_owned(), "degC".to_owned());
        assert!(Dry::of(&model).law(&change().with(channel), &[0.5], &[]).is_empty(), "no world has a temperature");
        let other = Candidate::one("stribeck", Kind::Plant, "Fs", "N", Vec::new());
        assert!(Dry::of(&model).law(&other, &[0.5], &[]).is_empty());
    }
}
