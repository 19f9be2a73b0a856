//! Jobs of a battery.

use super::carry_effect::Kind as CarryEffect;
use super::family::{Family, Group};
use super::needle_effect::Kind as NeedleEffect;
use super::scale::Scaled;
use super::{carry, piercing};
use crate::tasks::Case;
use blind::{Chance, Set};

/// Structure over noise where nothing else is hidden.
///
/// Choice: those of the crate `blind`.
const RATIOS: [f64; 3] = [1.0, 2.0, 4.0];
/// Effect over noise beside a structure, which then is as large as the noise.
///
/// Choice: that of the crate `blind`.
const BESIDE: f64 = 2.0;
/// A battery counts its cases on from its seed times this.
///
/// Choice: far more than a battery has cases.
pub const BATTERY: u64 = 1_000_003;

/// A case that can be made at any time.
#[derive(Clone, Debug)]
pub struct Job {
    /// Carried blocks or needles.
    pub group: Group,
    /// Family of the structure.
    pub family: Family,
    /// Its form.
    pub form: u32,
    /// An effect beside it, in carried blocks …
    pub carry_effect: Option<CarryEffect>,
    /// … or in a needle.
    pub needle_effect: Option<NeedleEffect>,
    /// Sizes over noise that are wanted: of the structure, then of the effect.
    pub ratios: Vec<f64>,
    /// Repeats it.
    pub seed: u64,
}

/// What comes of a job.
pub struct Made {
    /// With its structure.
    pub case: Case,
    /// The same noise and hand without it.
    pub clean: Case,
    /// Sizes that came out.
    pub scaled: Scaled,
    /// Noise of a reading, N; of the sum of both fingers in carried blocks.
    pub noise_n: f64,
}

impl Job {
    /// Performs it.
    pub fn make(&self) -> Made {
        match self.group {
            Group::Blocks => carry::make(self),
            Group::Needles => piercing::make(self),
        }
    }

    /// The question of a job.
    pub fn set(&self) -> Set {
        if self.hidden().is_some() { Set::Beside } else { Set::Structured }
    }

    /// Id of the effect beside the structure.
    pub fn hidden(&self) -> Option<&'static str> {
        self.carry_effect.map(CarryEffect::id).or(self.needle_effect.map(NeedleEffect::id))
    }
}

/// Numbers of cases of each family: alone, and beside an effect.
#[derive(Clone, Copy, Debug)]
pub struct Counts {
    /// Of carried blocks.
    pub blocks: [usize; 2],
    /// Of needles.
    pub needles: [usize; 2],
}

impl Counts {
    /// A few minutes on two cores.
    pub const USUAL: Self = Self { blocks: [6, 3], needles: [6, 3] };
}

/// Recordings with structured model error, alone and beside one effect, from one seed.
pub fn structured(counts: Counts, seed: u64) -> Vec<Job> {
    let mut chance = Chance::new(seed, 50);
    let mut jobs = Vec::new();
    for (group, [alone, beside]) in [(Group::Blocks, counts.blocks), (Group::Needles, counts.needles)] {
        for family in group.families() {
            for k in 0..alone + beside {
                jobs.push(job(group, *family, (k < alone).then_some(k), &mut chance));
            }
        }
    }
    for (k, job) in jobs.iter_mut().enumerate() {
        job.seed = seed.wrapping_mul(BATTERY).wrapping_add(k as u64);
    }
    jobs
}

/// A case of a family: the one of number `alone`, or one beside an effect that the structure does not look like.
fn job(group: Group, family: Family, alone: Option<usize>, chance: &mut Chance) -> Job {
    let form = chance.whole(0, Family::FORMS - 1);
    let tolerated = family.tolerated(group);
    let (mut carry_effect, mut needle_effect) = (None, None);
    if alone.is_none() {
        let carried: Vec<CarryEffect> =
            CarryEffect::ALL.into_iter().filter(|kind| !tolerated.contains(&kind.id())).collect();
        // Friction that a structure multiplies is known already.
        let fits = |kind: &NeedleEffect| !(family.needs_friction() && *kind == NeedleEffect::Shaft);
        let pierced: Vec<NeedleEffect> =
            NeedleEffect::ALL.into_iter().filter(|kind| !tolerated.contains(&kind.id()) && fits(kind)).collect();
        match group {
            Group::Blocks => carry_effect = Some(chance.pick(&carried)),
            Group::Needles => needle_effect = Some(chance.pick(&pierced)),
        }
    }
    let ratios = alone.map_or_else(|| vec![1.0, BESIDE], |k| vec![RATIOS[k % RATIOS.len()]]);
    Job { group, family, form, carry_effect, needle_effect, ratios, seed: 0 }
}
