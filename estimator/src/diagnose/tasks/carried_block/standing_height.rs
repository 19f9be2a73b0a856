//! Grip height while a held block stands on something: pad compliance under the load, and slips of the fingers.

use super::grasp_slip::{slips, ways};
use super::signals::Seen;
use super::stands::{Rows, Stand};
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::{CauseParameter, parameter};
use crate::diagnose::data::limits::LEAST_PIECES;
use crate::diagnose::data::row_means::mean_and_error;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{fingertip_slip, pad_compliance};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{Compared, View};
use crate::diagnose::selection::layout::{Layout, segments};
use crate::diagnose::selection::normal_equations::{LEAST_BLOCK, MOST_BLOCKS};
use crate::diagnose::selection::rules::Rules;
use estimation::identify::block::rests::{Rest, rests};
use estimation::identify::block::signals::object;
use estimation::identify::block::slip_detection::may_stand;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::signal::task::half_width;
use foundation::tasks::SystemState;
use foundation::words::amount;
use haptics::law::Kind;
use haptics::world::World;

/// Of so many rows of a rest one may be held out: every rest is fitted from its beginning to its end.
/// Derived: two, the least number of which one is left for the fit.
const HELD_OUT_RESTS: usize = 2;
/// Number of first rows of a rest that are never held out: only they show a slip at the beginning of the contact.
/// Choice: no case of the ablation reads it.
const RESTS_NEVER_HELD_OUT: usize = 4;

/// The comparison with the data for its texts.
pub struct Ground {
    pub compared: Compared,
    pub stands: Vec<Stand>,
    rows: Rows,
    /// Each slip's time, s, its distance, m, and the standard error of the distance with the time free, m.
    ways: Vec<[f64; 3]>,
}

/// Compares the causes that move the grip while a held block stands. `cross`: share of each finger's horizontal force
/// in its vertical channel. `None` if no block stood still long enough.
pub fn ground(
    seen: &[Seen<'_>],
    world: Option<&World>,
    cross: [f64; 2],
    rules: Rules,
) -> Result<Option<Ground>, EstimateError> {
    let period_s = seen.iter().map(|s| s.period_s).fold(0.0, f64::max);
    let mut rows = Rows { half_s: 0.5 * period_s, ..Rows::default() };
    let mut stands = Vec::new();
    for (recording, one) in seen.iter().enumerate() {
        for (k, rest) in rests(&one.blocks, one.count).into_iter().enumerate() {
            add(&mut rows, &mut stands, one, (recording, k % 2 == 1), (&rest, cross));
        }
    }
    let n = rows.stand.len();
    if stands.is_empty() || n < HELD_OUT_RESTS * LEAST_BLOCK {
        return Ok(None);
    }
    let of = |f: &dyn Fn(usize) -> f64| (0..n).map(f).collect::<Vec<f64>>();
    let mut base: Vec<Vec<f64>> = (0..stands.len()).map(|s| of(&|i| f64::from(u8::from(rows.stand[i] == s)))).collect();
    let give = rows.lift_n.clone();
    let contact = of(&|i| (stands[rows.stand[i]].below.len() + 1) as f64 * rows.lift_n[i]);
    // Pads damp and forces come a little late: both show while the load goes over to the ground, and neither is a cause
    // of its own.
    base.push(rows.lift_rate.clone());
    let model = [base.as_slice(), &[give.clone(), contact.clone()]].concat();
    let mut candidates = Vec::new();
    if world.is_some() {
        base.extend([give, contact]);
    } else {
        let cause = |columns, linear| Candidate::several(pad_compliance::ID, Kind::Plant, columns, linear).positive();
        candidates.push(cause(vec![give.clone()], vec![("give", "m/N")]));
        candidates.push(cause(vec![give, contact], vec![("give", "m/N"), ("give of a contact", "m/N")]));
    }
    slips(&rows, &stands, &model, &mut candidates);
    let stretch = segments(&rows.time_s, period_s, |i| rows.stand[i] != rows.stand[i - 1]);
    let since = |i: usize| i - stands[rows.stand[i]].first;
    let along: Vec<bool> = (0..n).map(|i| since(i) >= RESTS_NEVER_HELD_OUT && since(i) % HELD_OUT_RESTS == 0).collect();
    let layout = Layout { time_s: spread(&along), ..Layout::of(stretch, &along, period_s) };
    let floor_m = white_noise(&rows.height_m);
    let over = vec![(Variable::Time, rows.time_s.clone()), (Variable::Lift, rows.lift_n.clone())];
    let recording = rows.stand.iter().map(|s| stands[*s].recording).collect();
    // Each rest has a height of its own.
    let view = View { sensor: rows.stand.clone(), ..View::of(recording, over, best_seen) };
    let channel = Channel::new(rows.height_m.clone(), base, candidates, layout, rules);
    let study = settle(beside_errors(channel, &view, &[]).fit()?);
    let ways = ways(&rows, &stands, &model, &study);
    let channel = "height of the grip over the ground";
    let state = vec![SystemState::HoldOnGround; n];
    let compared = Compared { study, channel, unit: "m", floor: floor_m, along, state, view };
    Ok(Some(Ground { compared, stands, rows, ways }))
}

/// Order in which rows are held out together: each held-out block takes rows from all rests. The effect of a slip needs
/// rows before and after it, and a rest is shorter than a block of consecutive rows.
fn spread(along: &[bool]) -> Vec<f64> {
    let blocks = (along.iter().filter(|t| **t).count() / LEAST_BLOCK).clamp(1, MOST_BLOCKS);
    let before = along.iter().scan(0, |count, testable| {
        *count += usize::from(*testable);
        Some(*count)
    });
    before.enumerate().map(|(i, count)| ((count % blocks) * along.len() + i) as f64).collect()
}

fn add(
    rows: &mut Rows,
    stands: &mut Vec<Stand>,
    one: &Seen<'_>,
    (recording, placed): (usize, bool),
    (rest, cross): (&Rest, [f64; 2]),
) {
    let begins_s = rest.samples.first().map(|i| one.time_s(*i));
    let (from_s, samples) = if placed {
        one.put(rest.carry + 1, &rest.samples, cross)
    } else {
        (begins_s.unwrap_or(0.0), rest.samples.clone())
    };
    let picked = one.every(samples.into_iter());
    let object_m = one.blocks.signals.object_m();
    rows.object_m = rows.object_m.max(object_m);
    if picked.len() < LEAST_PIECES || !may_stand(picked.iter().map(|i| one.blocks.height[*i]), object_m) {
        return;
    }
    let half = half_width(&one.blocks.signals.time_s);
    let lift_rate = |i: usize| {
        let (before, after) = (i.saturating_sub(half), (i + half).min(one.blocks.lift.len() - 1));
        (one.blocks.lift[after] - one.blocks.lift[before]) / (one.time_s(after) - one.time_s(before)).max(1e-9)
    };
    let first = rows.stand.len();
    for i in &picked {
        rows.stand.push(stands.len());
        rows.time_s.push(one.time_s(*i));
        rows.height_m.push(one.blocks.height[*i]);
        let side = |f: usize| one.force[f][0][*i] - one.blocks.levels.bias_n[f].x;
        rows.lift_n.push(one.blocks.lift[*i] - cross[0] * side(0) - cross[1] * side(1));
        rows.lift_rate.push(lift_rate(*i));
        let ratio = |f: usize| {
            let bias = one.blocks.levels.bias_n[f];
            (one.force[f][1][*i] - bias.y).abs() / (one.force[f][0][*i] - bias.x).abs().max(0.1)
        };
        rows.ratio.push(ratio(0).max(ratio(1)));
    }
    let below = rest.below.iter().map(|k| k + 1).collect();
    stands.push(Stand {
        recording,
        number: rest.carry + 1,
        placed,
        below,
        first,
        end: rows.stand.len(),
        from_s,
        plain_from_s: begins_s.unwrap_or(from_s),
        samples: rest.samples.clone(),
    });
}

impl Ground {
    /// Standing phase to which a time belongs.
    fn stand_at(&self, time_s: f64) -> Option<&Stand> {
        self.stands.iter().find(|s| (s.from_s - self.rows.half_s..=self.rows.time_s[s.end - 1]).contains(&time_s))
    }

    /// Mean height of a rest without the slip found in it and without the compression under its load, m, and its
    /// standard error.
    pub fn level(&self, stand: &Stand) -> (f64, f64) {
        let picks = self.compared.study.picks();
        let Some(solved) = &self.compared.study.solved else { return (0.0, f64::INFINITY) };
        let mut give = vec![0.0; self.rows.stand.len()];
        // All but the heights of the rests.
        let columns: Vec<&Vec<f64>> = self
            .compared
            .study
            .baseline
            .iter()
            .skip(self.stands.len())
            .chain(picks.iter().flat_map(|p| &self.compared.study.candidates[*p].regressors).map(|column| &**column))
            .collect();
        for (column, value) in columns.iter().zip(&solved.values[self.stands.len()..]) {
            give.iter_mut().zip(column.iter()).for_each(|(g, c)| *g += value * c);
        }
        let own = (stand.first..stand.end).map(|i| self.rows.height_m[i] - give[i]);
        let (mean, error) = mean_and_error(&own.collect::<Vec<f64>>());
        let structured = self.compared.study.competition.as_ref().map_or(0.0, |c| c.rms);
        (mean, error.hypot(structured))
    }
}

/// Variable that best shows a cause.
fn best_seen(id: &str) -> Variable {
    if id == pad_compliance::ID { Variable::Lift } else { Variable::Time }
}

impl Told for Ground {
    fn states(&self, _: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        match candidate.id {
            fingertip_slip::ID => {
                let at = candidate.value("t0");
                let open = self.ways.iter().find(|[t0, ..]| Some(*t0) == at);
                for (way, [_, way_m, error_m]) in found.iter_mut().zip(open) {
                    (way.value, way.std_error) = (*way_m, way.std_error.hypot(*error_m));
                }
                found
            }
            // Two pads act side by side. The compliance of one is twice that of the pair, so its stiffness is half.
            pad_compliance::ID => {
                found.iter().take(1).map(|p| parameter("k_shear", 0.5 * p.value, 0.5 * p.std_error, "N/m")).collect()
            }
            _ => found,
        }
    }

    fn shows(&self, found: &Found<'_>) -> String {
        let value = found.value();
        if found.candidate.id == pad_compliance::ID {
            return "the grip sinks and rises with the load while a held block stands".to_owned();
        }
        let at = found.value_of("t0");
        let Some(stand) = self.stand_at(at) else {
            return format!("the fingers go on by {} although the block stands", amount(value, "m"));
        };
        let near = (stand.first..stand.end).filter(|i| (self.rows.time_s[*i] - at).abs() < 0.15);
        let ratio = near.map(|i| self.rows.ratio[i]).fold(0.0, f64::max);
        // A plain mean over the rest includes the shift while it lasts.
        let plain = (stand.first..stand.end).map(|i| self.rows.time_s[i]).filter(|t| *t >= stand.plain_from_s);
        let (rows, after) = plain.fold((0_u32, 0_u32), |(n, after), t| (n + 1, after + u32::from(t >= at)));
        let mean_off = value * f64::from(after) / f64::from(rows.max(1));
        let wrong: Vec<String> = stand.below.iter().map(|b| object(*b)).collect();
        let wrong = if wrong.is_empty() { "what it was taken from".to_owned() } else { wrong.join(" and ") };
        format!(
            "at {at:.2} s the fingers go on by {} although {} stands and the load does not ask for it (shear was {ratio:.2} of the \
             grip): heights from plain means there (of {wrong}) are {} off",
            amount(value, "m"),
            object(stand.number),
            amount(mean_off, "m")
        )
    }

    fn hidden_by(&self, candidate: &Candidate) -> Option<&'static str> {
        match candidate.id {
            fingertip_slip::ID => Some("blocks were not held on the ground for long enough to see the fingers move on"),
            pad_compliance::ID => {
                Some("the load hardly varied while a held block stood; press and lift while it stands")
            }
            _ => None,
        }
    }
}
