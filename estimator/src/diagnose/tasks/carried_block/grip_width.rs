//! Grip width of gripped blocks against the grip force: compliance of pads and blocks.

use super::signals::Seen;
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::{CauseParameter, parameter};
use crate::diagnose::data::limits::LEAST_ROWS_OF_A_FIT;
use crate::diagnose::free_run::channel::Pads;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{length_scale, pad_compliance, stiffness_hardening};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{Compared, View};
use crate::diagnose::selection::layout::{Layout, segments};
use crate::diagnose::selection::rules::Rules;
use estimation::identify::block::signals::object;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::tasks::SystemState;
use foundation::words::amount;
use haptics::law::Kind;
use haptics::law::contact::{Cushion, Densification, ONSET, StiffnessHardening};
use haptics::world::World;

/// Tried bends of the pads' law, from weak to strong, and tried ends of the foam.
/// Choice: no case of the ablation reads it.
const BENDS: Axis = Axis::cells(7);

/// The comparison with the data for its texts.
pub struct Grasp {
    pub compared: Compared,
    /// Mean distance and grip of each block, m and N.
    means: Vec<(f64, f64)>,
    /// Compliance of a pad at zero force in the model, m/N.
    modelled: f64,
    pub pads: Pads,
}

/// Rows of all recordings.
#[derive(Default)]
struct Rows {
    recording: Vec<usize>,
    number: Vec<usize>,
    time_s: Vec<f64>,
    width_m: Vec<f64>,
    grip_n: Vec<f64>,
    rate_m_s: Vec<f64>,
    /// Middle of the tips, x and y.
    place_m: [Vec<f64>; 2],
    state: Vec<SystemState>,
    stretch: Vec<usize>,
}

fn rows(seen: &[Seen<'_>]) -> Rows {
    let mut rows = Rows::default();
    let mut owner = Vec::new();
    for (k, one) in seen.iter().enumerate() {
        for number in 1..=one.count {
            for i in one.gripped(number) {
                rows.recording.push(k);
                rows.number.push(number);
                rows.time_s.push(one.time_s(i));
                rows.width_m.push(one.blocks.width[i]);
                rows.grip_n.push(one.blocks.grip[i]);
                rows.rate_m_s.push(one.blocks.width_rate[i]);
                rows.place_m.iter_mut().zip(&one.place).for_each(|(all, own)| all.push(own[i]));
                rows.state.push(one.state(i));
                owner.push((k, number));
            }
        }
    }
    let period_s = seen.iter().map(|s| s.period_s).fold(0.0, f64::max);
    rows.stretch = segments(&rows.time_s, period_s, |i| owner[i] != owner[i - 1]);
    rows
}

/// Compares the causes that change the grip width. `None` if blocks were hardly gripped.
pub fn grasp(seen: &[Seen<'_>], world: Option<&World>, rules: Rules) -> Result<Option<Grasp>, EstimateError> {
    let rows = rows(seen);
    let n = rows.number.len();
    if n < LEAST_ROWS_OF_A_FIT {
        return Ok(None);
    }
    let blocks = rows.number.iter().copied().max().unwrap_or(0);
    let known: Vec<Option<f64>> =
        (1..=blocks).map(|k| seen.iter().find_map(|s| s.known(k, "width_m").filter(|_| s.count >= k))).collect();
    let of = |f: &dyn Fn(usize) -> f64| (0..n).map(f).collect::<Vec<f64>>();
    let y = of(&|i| rows.width_m[i] - known[rows.number[i] - 1].unwrap_or(0.0));
    let mut base: Vec<Vec<f64>> = (1..=blocks)
        .filter(|k| known[k - 1].is_none())
        .map(|k| of(&|i| f64::from(u8::from(rows.number[i] == k))))
        .collect();
    // Damping of the pads is part of the base model.
    let rate = base.len();
    base.push(rows.rate_m_s.clone());
    let mut modelled = 0.0;
    if let Some(pad) = world.map(|w| w.pad.elastic()) {
        modelled = 1.0 / pad.spring.k1;
        base.push(of(&|i| -2.0 * pad.depth_m(rows.grip_n[i].max(0.0))));
    }
    let mut candidates = causes(&rows, modelled > 0.0);
    if known.iter().any(Option::is_some) {
        let column = of(&|i| known[rows.number[i] - 1].unwrap_or(0.0));
        candidates.push(Candidate::one(length_scale::ID, Kind::Instrument, "epsilon", "1", column));
    }
    let period_s = seen.iter().map(|s| s.period_s).fold(0.0, f64::max);
    let means = (1..=blocks)
        .map(|k| {
            let own: Vec<usize> = (0..n).filter(|i| rows.number[*i] == k).collect();
            let mean = |of: &[f64]| own.iter().map(|i| of[*i]).sum::<f64>() / own.len().max(1) as f64;
            (mean(&rows.width_m), mean(&rows.grip_n))
        })
        .collect();
    let floor_m = white_noise(&y);
    let along = vec![true; n];
    let layout = Layout::of(rows.stretch.clone(), &along, period_s);
    let (channel, state) = ("distance of the tips", rows.state);
    let time = (Variable::Time, rows.time_s.clone());
    let [place, _] = rows.place_m;
    let over = vec![time, (Variable::Grip, rows.grip_n), (Variable::Width, rows.width_m), (Variable::Place, place)];
    let view = View::of(rows.recording, over, best_seen);
    let channel_of = Channel::new(y, base, candidates, layout, rules);
    let study = settle(beside_errors(channel_of, &view, &[Variable::Grip, Variable::Width]).fit()?);
    let pads = Pads { time_s: rows.time_s, stretch: rows.stretch, period_s, rate };
    let compared = Compared { study, channel, unit: "m", floor: floor_m, along, state, view };
    Ok(Some(Grasp { compared, means, modelled, pads }))
}

fn causes(rows: &Rows, has_pads: bool) -> Vec<Candidate> {
    let (least_n, largest_n) =
        rows.grip_n.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), f| (a.min(f.max(0.0)), b.max(*f)));
    let mut found = Vec::new();
    if !has_pads {
        let column = rows.grip_n.iter().map(|f| -2.0 * f).collect();
        found.push(Candidate::one(pad_compliance::ID, Kind::Plant, "give", "m/N", column).positive());
    }
    if largest_n <= 0.0 {
        return found;
    }
    // Difference between the compression of a linear pad and of a hardening one with the same initial stiffness.
    let less = |cushion: &Cushion| -> Vec<f64> {
        rows.grip_n.iter().map(|f| 2.0 * (f.max(0.0) - cushion.depth_m(f.max(0.0)))).collect()
    };
    for share in BENDS.values() {
        let bend = 0.01 * 300.0_f64.powf(share) / largest_n.powi(2);
        let linear = Cushion::linear(1.0);
        let harder = Cushion { spring: StiffnessHardening { k3: bend, ..linear.spring }, ..linear };
        let cause = Candidate::one(stiffness_hardening::ID, Kind::Plant, "give", "m/N", less(&harder)).positive();
        found.push(cause.at("bend", bend, "1/N²"));
        let end_n = least_n + (0.3 + 0.65 * share) * (largest_n - least_n);
        let ending = Cushion { end: Densification::of(end_n / ONSET, 1.0), ..linear };
        let cause = Candidate::one(stiffness_hardening::ID, Kind::Plant, "give", "m/N", less(&ending)).positive();
        found.push(cause.at("end", end_n, "N"));
    }
    found
}

impl Grasp {
    /// True if this cause was found.
    pub fn has(&self, id: &str) -> bool {
        self.compared.study.has(id)
    }

    /// Compliance of one pad at zero force, m/N: as found, or as in the model.
    fn first_give(&self) -> f64 {
        let found = self.compared.study.found();
        found.iter().find(|(c, _)| c.id == pad_compliance::ID).map_or(self.modelled, |(_, values)| values[0])
    }
}

/// Variable that best shows a cause.
fn best_seen(id: &str) -> Variable {
    if id == length_scale::ID { Variable::Width } else { Variable::Grip }
}

impl Told for Grasp {
    fn states(&self, _: usize, candidate: &Candidate, found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        let give = found.first().map_or((0.0, 0.0), |p| (p.value, p.std_error));
        match candidate.id {
            stiffness_hardening::ID => {
                let first = self.first_give();
                let k1 = 1.0 / first.max(f64::MIN_POSITIVE);
                let mut all = vec![parameter("k1", k1, 0.0, "N/m")];
                match candidate.searched.first() {
                    Some(s) if s.name == "bend" => {
                        // To lowest order the regressor is bend · F³, so its coefficient is k3 give/(k1⁴ give).
                        let k3 = |give: f64| give / first.max(f64::MIN_POSITIVE) * s.value * k1.powi(3);
                        all.push(parameter("k3", k3(give.0), k3(give.1), "N/m³"));
                    }
                    Some(s) => all.push(parameter("end", s.value, 0.0, "N")),
                    None => {}
                }
                all
            }
            _ => found,
        }
    }

    fn shows(&self, found: &Found<'_>) -> String {
        let value = found.value();
        match found.candidate.id {
            pad_compliance::ID => {
                let short: Vec<String> = self
                    .means
                    .iter()
                    .enumerate()
                    .filter(|(_, (_, grip))| *grip > 0.0)
                    .map(|(k, (width, grip))| {
                        let give = 2.0 * grip / value.max(f64::MIN_POSITIVE);
                        format!("{} {:.1} %", object(k + 1), 100.0 * give / (width + give))
                    })
                    .collect();
                format!(
                    "the distance of the tips falls with the grip force, {} each pad: plain means come out short of the \
                     width at no force ({})",
                    amount(value, "N/m"),
                    short.join(", ")
                )
            }
            stiffness_hardening::ID => {
                "the harder the grip already is, the less the tips come together under more of it".to_owned()
            }
            length_scale::ID => format!("all distances are {:+.2} % off the widths that are known", 100.0 * value),
            other => format!("{other} shows in the distance of the tips"),
        }
    }

    fn hidden_by(&self, candidate: &Candidate) -> Option<&'static str> {
        match candidate.id {
            pad_compliance::ID => {
                Some("the grip hardly varied while a block was held; squeeze softly and hard while it stands still")
            }
            stiffness_hardening::ID => {
                Some("the grip varied too little to see a bend; squeeze from light to hard and back")
            }
            length_scale::ID => Some("the widths of the blocks are not known; state one in the sidecar"),
            _ => None,
        }
    }
}
