//! The sets of cases that make a battery.

use super::case::{Case, Object, Truth, make, make_with_object};
use super::chance::Chance;
use super::draw::{Bench, Spec, Structure};
use super::effect::{Effect, Shows};
use super::plan::Log;
use super::structure::shows_in;
use super::tolerated::tolerated;

/// Which question a case asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Set {
    /// Nothing is hidden.
    Null,
    /// One effect, in a log that can show it, at 100 Hz or more.
    Single,
    /// Two effects at once.
    Pair,
    /// Something that no table of causes knows.
    Nameless,
    /// One effect in a log that is hard: 20 Hz, short, slow, one way, pulled only.
    Hard,
    /// Structured model error, and nothing else.
    Structured,
    /// One effect beside a weaker structured model error.
    Beside,
}

impl Set {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Single => "single",
            Self::Pair => "pair",
            Self::Nameless => "nameless",
            Self::Hard => "hard",
            Self::Structured => "structured",
            Self::Beside => "beside",
        }
    }
}

/// A case that can be made at any time.
#[derive(Clone, Debug)]
pub struct Job {
    /// Which question.
    pub set: Set,
    /// What is asked for.
    pub spec: Spec,
    /// Repeats it.
    pub seed: u64,
}

impl Job {
    /// Makes the case and, apart from it, its truth.
    pub fn make(&self) -> (Case, Truth) {
        make(&self.spec, self.seed)
    }

    /// The same, and what was recorded.
    pub fn make_with_object(&self) -> (Case, Truth, Object) {
        make_with_object(&self.spec, &[], self.seed)
    }
}

/// How many of each.
#[derive(Clone, Copy, Debug)]
pub struct Counts {
    /// Cases without anything.
    pub nulls: usize,
    /// Cases of every effect at every ratio.
    pub per_effect: usize,
    /// Cases with two effects.
    pub pairs: usize,
    /// Cases of every nameless effect.
    pub per_nameless: usize,
    /// Cases in hard logs.
    pub hard: usize,
}

impl Counts {
    /// What a release is judged by.
    pub const WHOLE: Self = Self { nulls: 600, per_effect: 3, pairs: 160, per_nameless: 20, hard: 200 };
    /// What fits into a minute.
    pub const FAST: Self = Self { nulls: 40, per_effect: 1, pairs: 10, per_nameless: 2, hard: 10 };
}

/// Numbers of recordings with structured model error, for each family: with nothing from the catalogue, and beside an effect.
#[derive(Clone, Copy, Debug)]
pub struct StructureCounts {
    /// Cranks of 20 s: alone, beside an effect.
    pub cranks: [usize; 2],
    /// Cranks of 60 s, with a structure over the state.
    pub long_cranks: [usize; 2],
    /// Mechanisms of 20 s.
    pub mechanisms: [usize; 2],
}

impl StructureCounts {
    /// A few minutes on two cores.
    pub const USUAL: Self = Self { cranks: [4, 2], long_cranks: [4, 2], mechanisms: [4, 2] };
}

/// Effect over noise in the main set.
pub const RATIOS: [f64; 4] = [0.25, 0.5, 1.0, 2.0];
const RATES_HZ: [f64; 4] = [100.0, 250.0, 500.0, 1000.0];

/// All cases of a battery, from one seed.
pub fn battery(counts: Counts, seed: u64) -> Vec<Job> {
    let mut chance = Chance::new(seed, 11);
    let mut jobs = nulls(counts.nulls, &mut chance);
    for _ in 0..counts.per_effect {
        for effect in Effect::NAMED {
            for ratio in RATIOS {
                // A size means nothing there: once is enough.
                if effect.shows() == Shows::Grossly && ratio != 1.0 {
                    continue;
                }
                jobs.push(single(effect, ratio, &mut chance));
            }
        }
    }
    jobs.extend((0..counts.pairs).map(|_| pair(&mut chance)));
    for effect in Effect::NAMELESS {
        for k in 0..counts.per_nameless {
            let ratio = if k % 4 == 3 { 0.5 } else { chance.pick(&[1.0, 2.0]) };
            let mut job = single(effect, ratio, &mut chance);
            job.set = Set::Nameless;
            jobs.push(job);
        }
    }
    jobs.extend((0..counts.hard).map(|k| hard(k, &mut chance)));
    // Each case has a seed of its own, so that one can be looked at alone.
    for (k, job) in jobs.iter_mut().enumerate() {
        job.seed = seed.wrapping_mul(1_000_003).wrapping_add(k as u64);
    }
    jobs
}

fn length_s(rate_hz: f64, chance: &mut Chance) -> f64 {
    // Long and fast together only now and then: they cost most and ask nothing new.
    if rate_hz > 400.0 && chance.happens(0.8) { chance.between(10.0, 20.0) } else { chance.between(10.0, 40.0) }
}

fn nulls(count: usize, chance: &mut Chance) -> Vec<Job> {
    (0..count)
        .map(|k| {
            let bench = chance.pick(&[
                Bench::OneFinger,
                Bench::OneFinger,
                Bench::OneFinger,
                Bench::TwoFingers,
                Bench::Linear,
                Bench::Angular,
            ]);
            let rate_hz = if k % 5 == 4 { 20.0 } else { chance.pick(&RATES_HZ) };
            let log = chance.pick(&[Log::Mixed, Log::Mixed, Log::Mixed, Log::OneWay, Log::PullOnly, Log::Slow]);
            let spec =
                Spec { log, rate_hz, seconds: length_s(rate_hz, chance), ..Spec::hiding(Vec::new(), 0.0, bench) };
            Job { set: Set::Null, spec, seed: 0 }
        })
        .collect()
}

/// Where an effect can be hidden, the crank with one finger most often.
fn bench_for(effect: Effect, chance: &mut Chance) -> Bench {
    let mut places = Vec::new();
    if effect.on_crank() {
        places.extend([Bench::OneFinger; 5]);
    }
    if effect.on_two_fingers() {
        places.push(Bench::TwoFingers);
    }
    for (bench, angular) in [(Bench::Linear, false), (Bench::Angular, true)] {
        if effect.on_mechanism(angular) {
            places.push(bench);
        }
    }
    chance.pick(&places)
}

/// The textbook's form in half of the cases, another in the others.
fn form_for(effect: Effect, bench: Bench, chance: &mut Chance) -> u32 {
    let forms = effect.forms_on(bench.is_crank());
    if forms.end - forms.start < 2 || chance.happens(0.5) {
        forms.start
    } else {
        chance.whole(forms.start + 1, forms.end - 1)
    }
}

fn single(effect: Effect, ratio: f64, chance: &mut Chance) -> Job {
    let bench = bench_for(effect, chance);
    let form = form_for(effect, bench, chance);
    let rate_hz = chance.pick(&RATES_HZ);
    let seconds = length_s(rate_hz, chance);
    let spec = Spec { rate_hz, seconds, ..Spec::hiding(vec![(effect, form)], ratio, bench) };
    Job { set: Set::Single, spec, seed: 0 }
}

/// Pairs that a good recording can tell apart: no two that act in the same way.
fn may_go_together(a: Effect, b: Effect) -> bool {
    use Effect::{Asymmetry, Bias, CrossAxis, Drift, Eccentric, JointOffset, Leak, LengthScale, Tilt};
    let alike: [&[Effect]; 5] = [
        &[Eccentric, Tilt, Bias],
        &[Leak, Drift],
        &[Asymmetry, CrossAxis],
        &[JointOffset, LengthScale],
        // Both take over the whole of the friction: what they do together is no sum.
        &[Effect::Backlash, Effect::Hysteresis],
    ];
    a != b && !alike.iter().any(|group| group.contains(&a) && group.contains(&b))
}

fn pair(chance: &mut Chance) -> Job {
    let fits =
        |e: Effect| e.on_crank() && e.shows() != Shows::Grossly && !matches!(e, Effect::Gain | Effect::Saturation);
    let (a, b) = loop {
        let (a, b) = (chance.pick(&Effect::NAMED), chance.pick(&Effect::NAMED));
        if fits(a) && fits(b) && may_go_together(a, b) {
            break (a, b);
        }
    };
    let bench = Bench::OneFinger;
    let effects = [a, b].map(|e| (e, form_for(e, bench, chance))).to_vec();
    let rate_hz = chance.pick(&RATES_HZ);
    let seconds = length_s(rate_hz, chance);
    Job { set: Set::Pair, spec: Spec { rate_hz, seconds, ..Spec::hiding(effects, 1.0, bench) }, seed: 0 }
}

/// Structures that come again with the state, however long a recording is.
const OVER_STATE: [Effect; 4] = [Effect::AngleField, Effect::SpeedField, Effect::LoadField, Effect::StateField];
/// Structure over noise where nothing else is hidden.
const STRUCTURE_RATIOS: [f64; 3] = [1.0, 2.0, 4.0];

/// Recordings with structured model error, alone and beside one effect, from one seed.
pub fn structured(counts: StructureCounts, seed: u64) -> Vec<Job> {
    let mut chance = Chance::new(seed, 14);
    let cranks = [Bench::OneFinger, Bench::OneFinger, Bench::OneFinger, Bench::OneFinger, Bench::TwoFingers];
    let mechanisms = [Bench::Linear, Bench::Angular];
    let mut jobs = Vec::new();
    let mut group = |families: &[Effect], benches: &[Bench], seconds: f64, [alone, beside]: [usize; 2]| {
        for family in families.iter().filter(|f| shows_in(**f, benches[0], Log::Mixed)) {
            for k in 0..alone + beside {
                let bench = loop {
                    let bench = chance.pick(benches);
                    if bench != Bench::TwoFingers || family.on_two_fingers() {
                        break bench;
                    }
                };
                jobs.push(with_structure(*family, bench, seconds, (k < alone).then_some(k), &mut chance));
            }
        }
    };
    group(&Effect::STRUCTURES, &cranks, 20.0, counts.cranks);
    group(&OVER_STATE, &cranks, 60.0, counts.long_cranks);
    group(&Effect::STRUCTURES, &mechanisms, 20.0, counts.mechanisms);
    for (k, job) in jobs.iter_mut().enumerate() {
        job.seed = seed.wrapping_mul(1_000_003).wrapping_add(k as u64);
    }
    jobs
}

/// A case of a family: the one of number `alone`, or one beside an effect.
fn with_structure(family: Effect, bench: Bench, seconds: f64, alone: Option<usize>, chance: &mut Chance) -> Job {
    let form = chance.whole(0, family.forms() - 1);
    let rate_hz = chance.pick(&[100.0, 200.0, 500.0]);
    let Some(k) = alone else {
        let effect = beside(family, bench, chance);
        let effects = vec![(effect, form_for(effect, bench, chance))];
        let structure = Some(Structure { effect: family, form, ratio: 1.0 });
        let spec = Spec { effects, ratio: 2.0, structure, bench, log: Log::Mixed, rate_hz, seconds };
        return Job { set: Set::Beside, spec, seed: 0 };
    };
    let logs = [Log::Mixed, Log::Mixed, Log::Mixed, Log::Mixed, Log::Mixed, Log::OneWay, Log::PullOnly, Log::Slow];
    let log = loop {
        let log = chance.pick(&logs);
        if shows_in(family, bench, log) {
            break log;
        }
    };
    let ratio = STRUCTURE_RATIOS[k % STRUCTURE_RATIOS.len()];
    let structure = Some(Structure { effect: family, form, ratio });
    let spec = Spec { effects: Vec::new(), ratio: 0.0, structure, bench, log, rate_hz, seconds };
    Job { set: Set::Structured, spec, seed: 0 }
}

/// An effect that can be told from a structure of that family.
fn beside(family: Effect, bench: Bench, chance: &mut Chance) -> Effect {
    let is_friction = matches!(family, Effect::LoadField | Effect::FrictionOverAngle | Effect::FrictionWander);
    let there = |effect: Effect| match bench {
        Bench::OneFinger => effect.on_crank(),
        Bench::TwoFingers => effect.on_two_fingers(),
        Bench::Linear | Bench::Angular => effect.on_mechanism(bench == Bench::Angular),
    };
    let fits = |effect: Effect| {
        // These replace the known friction, or leave none that could be modulated.
        let replaces = matches!(effect, Effect::Backlash | Effect::Hysteresis | Effect::Coulomb | Effect::Viscous);
        // A grasp that wanders bends the path far more than any effect on it.
        let hides = family == Effect::GraspCreep && effect.shows() == Shows::Path;
        let odd = effect.shows() == Shows::Grossly || matches!(effect, Effect::Gain | Effect::Saturation);
        let unfit = odd || hides || (is_friction && replaces) || tolerated(family).contains(&effect.id());
        there(effect) && !unfit
    };
    loop {
        let effect = chance.pick(&Effect::NAMED);
        if fits(effect) {
            return effect;
        }
    }
}

/// Minute-long recordings at 1 kHz, for the time that an answer takes.
pub fn long(count: usize, seed: u64) -> Vec<Job> {
    let mut chance = Chance::new(seed, 12);
    let mut job = |k: u64| {
        let effect = chance.pick(&[Effect::Stribeck, Effect::Ripple, Effect::Hysteresis, Effect::Pad]);
        let mut job = single(effect, 1.0, &mut chance);
        (job.spec.rate_hz, job.spec.seconds, job.seed) = (1000.0, 60.0, seed.wrapping_add(k));
        job
    };
    (0..count as u64).map(&mut job).collect()
}

fn hard(k: usize, chance: &mut Chance) -> Job {
    let effect = chance.pick(&Effect::NAMED);
    let ratio = chance.pick(&[0.5, 1.0, 2.0]);
    let mut job = single(effect, ratio, chance);
    job.set = Set::Hard;
    let spec = &mut job.spec;
    match k % 6 {
        0 => (spec.rate_hz, spec.seconds) = (20.0, 10.0),
        1 => (spec.rate_hz, spec.seconds) = (20.0, 30.0),
        2 => spec.seconds = 4.0,
        3 => spec.log = Log::Slow,
        4 => spec.log = chance.pick(&[Log::OneWay, Log::Steady]),
        _ => spec.log = Log::PullOnly,
    }
    job
}
