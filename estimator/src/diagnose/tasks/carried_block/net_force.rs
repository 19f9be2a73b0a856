//! Forces while blocks are carried, beside those while nothing is touched: weight, inertia, cables, and what is wrong
//! with the sensors.
//!
//! Time delay of the forces after the motion of carried blocks, from the shift for which their weight and inertia
//! explain most.

use super::cable::{cables, errors, pulls};
use super::free_body::Airborne;
use super::net_force_candidates::{instrument, plant};
use super::rows::{Place, Row, Rows};
use super::signals::Seen;
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::{CauseParameter, parameter};
use crate::diagnose::data::limits::{LEAST_ROWS_OF_A_FIT, MOST_ROUNDS};
use crate::diagnose::extension::hypothetical_worlds::{Act, Simulated};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{
    added_constraint, force_bias, force_cross_axis, force_drift, force_gain, force_step, gravity_tilt, inertia,
    mass_change, viscous_friction,
};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::recording::delay_scan::{Demands, Late, left_of_fit, look_by_samples};
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use crate::diagnose::selection::stepwise::SelectedTerm;
use estimation::identify::block::signals::object;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::tasks::SystemState;
use foundation::words::amount;
use haptics::world::{Cable, World};
use std::collections::BTreeSet;

/// The comparison with the data for its texts.
pub struct Carry<'a> {
    /// Delay of the forces after the motion, if it is significant.
    pub late: Option<Late>,
    /// Its floor is the noise of a sum of two fingers.
    pub compared: Compared,
    /// Standard errors of a cable's stiffness, anchor and length.
    cable_errors: Option<[f64; 4]>,
    /// Numbers of the blocks whose weights are estimated, in the order of the model's regressors.
    pub weighed: Vec<usize>,
    pub airborne: Airborne<'a>,
}

/// Compares the causes that may act on carried blocks and on the sensors. `world`: its cables belong to the model.
pub fn carry<'a>(seen: &'a [Seen<'a>], world: Option<&World>, rules: Rules) -> Result<Carry<'a>, EstimateError> {
    let rows = Rows::of(seen);
    let is_carried = |r: &Row| matches!(r.place, Place::Carried { .. });
    // Every other row is testable, so a short effect has rows both in the fit and among the held-out ones.
    let testable: Vec<bool> = (0..rows.all.len()).map(|i| i % 2 == 0).collect();
    let carried = rows.all.iter().filter(|r| is_carried(r)).count();
    if carried < LEAST_ROWS_OF_A_FIT {
        return Err(EstimateError::TooFewSamples {
            recording: seen.first().map(|s| s.blocks.recording.name.clone()).unwrap_or_default(),
            samples: carried,
            what: " of carried blocks, a filter window apart".to_owned(),
            needed: LEAST_ROWS_OF_A_FIT,
        });
    }
    let known: Vec<Option<f64>> =
        (1..=rows.blocks()).map(|k| seen.iter().find_map(|s| s.known_weight_n(k).filter(|_| s.count >= k))).collect();
    let base = base(&rows, world, &known);
    let given = rows.carried(|one, row, number, axis| known[number - 1].map_or(0.0, |w| needed(one, row, w, axis)));
    let y: Vec<f64> = rows.all.iter().zip(&given).map(|(r, g)| rows.force_n(r) - g).collect();
    // A row of one finger has the noise of one sensor.
    let weight: Vec<f64> =
        rows.all.iter().map(|r| if is_carried(r) { 1.0 } else { std::f64::consts::SQRT_2 }).collect();
    let plant = plant(&rows);
    // The search for a cable precedes the comparison.
    let cables = cables(&rows, &y, &base, &weight);
    let mut candidates = plant;
    candidates.extend(instrument(&rows, &known, &given));
    candidates.extend(rows.jumps().candidates(&force_step::OF_FINGERS, &base, &y));
    candidates.extend(cables);
    let layout = Layout::of(rows.stretch.clone(), &testable, rows.period_s()).weighted(weight);
    let view = view(&rows);
    let channel = Channel::new(y, base, candidates, layout, rules);
    let channel = beside_errors(channel, &view, &[Variable::Lift, Variable::Acceleration]);
    let study = settle(beside_swinging(channel, &rows)?);
    let cable_errors = errors(&rows, &study);
    let along: Vec<bool> = rows.all.iter().map(is_carried).collect();
    let carried: Vec<f64> = study.target.iter().zip(&along).filter(|(_, is)| **is).map(|(y, _)| *y).collect();
    let floor = white_noise(&carried);
    let of_carried = |c: &bool| if *c { SystemState::HoldAboveGround } else { SystemState::FreeMotion };
    let state = along.iter().map(of_carried).collect();
    let channel = "net force on carried blocks";
    let late = late(&rows, &known);
    let compared = Compared { study, channel, unit: "N", floor, along, state, view };
    let weighed = (1..=known.len()).filter(|k| known[k - 1].is_none()).collect();
    let airborne = Airborne::of(rows, world, known);
    Ok(Carry { late, compared, cable_errors, weighed, airborne })
}

/// Comparison without causes that may be misfit of a cable or wall: its law is a linear spring with a damper, but a real
/// cable turns in the grip and sags.
fn without_remainders(mut channel: Channel) -> Result<ChannelFit, EstimateError> {
    let mut study = channel.clone().fit()?;
    for _ in 0..MOST_ROUNDS {
        let of = |c: &SelectedTerm| &study.candidates[c.candidate];
        let cable =
            study.chosen.iter().filter(|c| of(c).id == added_constraint::ID).map(|c| c.score).fold(0.0, f64::max);
        let is_rest = |c: &&SelectedTerm| of(c).id != added_constraint::ID && c.score < channel.rules.remainder * cable;
        let rests: Vec<&str> = study.chosen.iter().filter(is_rest).map(|c| of(c).id).collect();
        if rests.is_empty() {
            break;
        }
        channel.candidates.retain(|c| !rests.contains(&c.id));
        study = channel.clone().fit()?;
    }
    Ok(study)
}

/// Variables of the plots: motion of the block along the row's own axis, and grip.
fn view(rows: &Rows<'_>) -> View {
    let sensor = |r: &Row| match r.place {
        Place::Carried { axis, .. } => axis,
        Place::Free { finger, axis } => 2 + 2 * finger + axis,
    };
    let own = |of: &dyn Fn(&Seen<'_>, &Row, usize) -> f64| rows.carried(|one, row, _, axis| of(one, row, axis));
    let over = vec![
        (Variable::Time, rows.column(|r| r.time_s)),
        (Variable::Velocity, own(&|one, r, axis| one.velocity[axis][r.i])),
        (Variable::Acceleration, own(&|one, r, axis| one.acceleration[axis][r.i])),
        (Variable::Place, rows.column(|r| rows.seen[r.recording].place[0][r.i])),
        (Variable::Grip, rows.column(|r| rows.seen[r.recording].blocks.grip[r.i])),
        (Variable::Lift, rows.column(|r| rows.seen[r.recording].blocks.lift[r.i])),
    ];
    let recording = rows.all.iter().map(|r| r.recording).collect();
    View { sensor: rows.all.iter().map(sensor).collect(), ..View::of(recording, over, best_seen) }
}

/// Force needed to carry a weight along an axis, N, with its inertia (weight over gravity).
fn needed(one: &Seen<'_>, row: &Row, weight_n: f64, axis: usize) -> f64 {
    let up = if axis == 1 { 1.0 } else { 0.0 };
    let gravity = one.blocks.recording.meta.gravity().max(f64::MIN_POSITIVE);
    weight_n * (up + one.acceleration[axis][row.i] / gravity)
}

/// Regressors of the base model: one weight per block with its inertia, and the cables of a world.
fn base(rows: &Rows<'_>, world: Option<&World>, known: &[Option<f64>]) -> Vec<Vec<f64>> {
    let unknown = (1..=rows.blocks()).filter(|k| known[k - 1].is_none());
    let mut base: Vec<Vec<f64>> = unknown
        .map(|k| rows.carried(|one, row, number, axis| if number == k { needed(one, row, 1.0, axis) } else { 0.0 }))
        .collect();
    for (k, block) in world.iter().flat_map(|w| &w.blocks).enumerate() {
        let Some(cable) = &block.cable else { continue };
        // Its damping is a candidate of its own.
        base.push(pulls(rows, k + 1, &Cable { damping_n_s_m: 0.0, ..*cable }));
    }
    base
}

/// The comparison, with a check for pad compliance. A block swings in compliant pads and lags behind the grip, which
/// looks like inertia. Inertia is named only if it is also found beside each block's swinging. The swinging is no
/// regular part of the model, because its regressor contains noise of the forces.
fn beside_swinging(channel: Channel, rows: &Rows<'_>) -> Result<ChannelFit, EstimateError> {
    let plain = without_remainders(channel.clone())?;
    let has_mass = |study: &ChannelFit| study.has(inertia::ID);
    if !has_mass(&plain) {
        return Ok(plain);
    }
    let curves: Vec<[Vec<f64>; 2]> = rows.seen.iter().map(Seen::force_curve).collect();
    let swing = |k: usize| {
        rows.carried(|_, row, number, axis| if number == k { curves[row.recording][axis][row.i] } else { 0.0 })
    };
    let base = channel.baseline.iter().cloned().chain((1..=rows.blocks()).map(swing)).collect();
    let swinging = without_remainders(Channel { baseline: base, ..channel })?;
    Ok(if has_mass(&swinging) { plain } else { swinging })
}

impl Carry<'_> {
    /// True if this cause was found.
    pub fn has(&self, id: &str) -> bool {
        self.compared.study.has(id)
    }

    /// Share of each finger's horizontal force in its vertical channel, as found.
    pub fn cross(&self) -> [f64; 2] {
        let mut found = [0.0; 2];
        for (candidate, values) in self.compared.study.found() {
            match candidate.linear[0].0 {
                "kappa_yx1" => found[0] += values[0],
                "kappa_yx2" => found[1] += values[0],
                "kappa_yx" => found = found.map(|f| f + values[0]),
                _ => {}
            }
        }
        found
    }

    /// The same parameters with the block of a change of weight or of a cable, and with a cable's standard errors.
    pub fn of_blocks(&self, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        let column = &candidate.regressors[0];
        let rows = &self.airborne.rows;
        let number = rows.touched(column);
        // Without a block, the cause concerns all blocks.
        let alone = || (0..column.len()).all(|i| column[i] == 0.0 || rows.all[i].number() == number);
        if [mass_change::ID, added_constraint::ID].contains(&candidate.id) && alone() {
            found.push(parameter("block", number as f64, 0.0, "1"));
        }
        if candidate.id == force_step::ID {
            rows.jumps().widen(candidate, &mut found);
        }
        if let (added_constraint::ID, Some(errors)) = (candidate.id, self.cable_errors) {
            for (name, error) in ["k", "anchor x", "anchor y", "length"].into_iter().zip(errors) {
                found.iter_mut().filter(|p| p.name == name).for_each(|p| p.std_error = p.std_error.max(error));
            }
        }
        found
    }
}

/// Variable that best shows a cause.
fn best_seen(id: &str) -> Variable {
    match id {
        inertia::ID => Variable::Acceleration,
        viscous_friction::ID => Variable::Velocity,
        added_constraint::ID => Variable::Place,
        force_cross_axis::ID => Variable::Grip,
        force_gain::ID | gravity_tilt::ID => Variable::Lift,
        _ => Variable::Time,
    }
}

impl Told for Carry<'_> {
    fn states(&self, _: usize, candidate: &Candidate, found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        self.of_blocks(candidate, found)
    }

    fn shows(&self, found: &Found<'_>) -> String {
        let value = |k: usize| found.parameters.get(k).map_or(0.0, |p| p.value);
        match found.candidate.id {
            inertia::ID => {
                let masses: Vec<String> = found
                    .parameters
                    .iter()
                    .enumerate()
                    .map(|(k, p)| format!("{} {}", object(k + 1), amount(1e3 * p.value, "g")))
                    .collect();
                format!(
                    "the force follows the acceleration of carried blocks more than the mass of their weight does (by {})",
                    masses.join(", ")
                )
            }
            mass_change::ID => {
                "the lift changes while a block is carried, and the forces of empty fingers do not".to_owned()
            }
            force_bias::ID => "empty fingers feel a force, and the same is missing while blocks are carried".to_owned(),
            force_step::ID => "the forces of empty fingers jump, and those of carried blocks with them".to_owned(),
            force_drift::ID => {
                "the forces of empty fingers go with time, and those of carried blocks with them".to_owned()
            }
            force_gain::ID => {
                format!("carried blocks weigh {:+.1} % of what is known of them too much", 100.0 * value(0))
            }
            force_cross_axis::ID => "one axis of a finger's force follows the other".to_owned(),
            added_constraint::ID => {
                "the net force on a carried block pulls towards one place from a distance on".to_owned()
            }
            gravity_tilt::ID => "a carried block pulls to one side in proportion to its weight".to_owned(),
            viscous_friction::ID => "the force follows the speed of the carried block".to_owned(),
            other => format!("{other} shows in the net force"),
        }
    }

    fn hidden_by(&self, candidate: &Candidate) -> Option<&'static str> {
        Some(match candidate.id {
            inertia::ID => "blocks were carried too evenly; carry them fast, with stops",
            mass_change::ID => "blocks were not carried for long; hold one still for some seconds",
            force_bias::ID => "nothing was ever let go; start and end with a second of free motion",
            force_drift::ID => "the recording is too short, or nothing was let go at both ends",
            force_cross_axis::ID => "the grip hardly varied; squeeze softly and hard while a block is carried",
            added_constraint::ID => "blocks were hardly moved while they were carried",
            gravity_tilt::ID => "no block was carried for long enough",
            viscous_friction::ID => "blocks were carried too slowly",
            _ => return None,
        })
    }
}

impl Simulated for Carry<'_> {
    fn base(&self, values: &[f64]) -> Vec<Act> {
        let of = |(number, weight_n): (&usize, &f64)| {
            let found = vec![parameter("weight", *weight_n, 0.0, "N"), parameter("block", *number as f64, 0.0, "1")];
            ("weight".to_owned(), found)
        };
        self.weighed.iter().zip(values).map(of).collect()
    }

    /// A world has no drag in the air, no mass without weight, and no sudden change of weight.
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        let mut found = candidate.parameters(values);
        if candidate.id != added_constraint::ID {
            found.truncate(candidate.linear.len());
        }
        match candidate.id {
            gravity_tilt::ID | added_constraint::ID => {}
            // The start of a leak does not carry over to another recording: there it leaks from the start.
            mass_change::ID if found.iter().any(|p| p.name == "rate" && p.value < 0.0) => {}
            _ => return None,
        }
        Some((candidate.id.to_owned(), self.of_blocks(candidate, found)))
    }

    /// Such a drift leaves alone what its sensors read before.
    fn is_late(&self, candidate: &Candidate) -> bool {
        let Some((_, time_s)) = self.compared.view.over.iter().find(|(v, _)| *v == Variable::Time) else {
            return false;
        };
        let drifts = candidate.id == force_drift::ID && candidate.searched.is_empty();
        drifts
            && candidate.regressors.iter().any(|column| {
                let sensors: BTreeSet<usize> =
                    (0..column.len()).filter(|i| column[*i] != 0.0).map(|i| self.compared.view.sensor[i]).collect();
                let silent = |i: &usize| column[*i] == 0.0 && sensors.contains(&self.compared.view.sensor[*i]);
                (0..column.len()).filter(silent).any(|i| time_s[i] > 0.0)
            })
    }
}

/// Limits of a delay: beyond the longest one a hand is already at another movement.
/// Choice: not varied one by one. A delay that it finds must improve the repeated fit, or it is discarded.
const DEMANDS: Demands = Demands { longest_s: 0.12, enough: 0.8, leaves: 0.9, likelier: 40.0 };

/// Delay with the smallest residual of weights, their inertia and constant sensor errors. `known`: weights that the
/// sidecar states, N.
pub fn late(rows: &Rows<'_>, known: &[Option<f64>]) -> Option<Late> {
    let carried: Vec<&Row> = rows.all.iter().filter(|r| matches!(r.place, Place::Carried { .. })).collect();
    let sample_s = rows.seen.iter().map(|s| s.sample_s).fold(0.0, f64::max);
    look_by_samples(sample_s, &DEMANDS, &|by| left(rows, &carried, known, by))
}

/// Residual power per row, and number of rows, with the forces of this many samples later.
fn left(rows: &Rows<'_>, carried: &[&Row], known: &[Option<f64>], by: isize) -> Option<(f64, f64)> {
    let blocks = rows.blocks();
    let mut columns = vec![Vec::new(); blocks + 2];
    let mut y = Vec::new();
    for row in carried {
        let Place::Carried { number, axis } = row.place else { continue };
        let one = &rows.seen[row.recording];
        let Some(acceleration) = row.i.checked_add_signed(-by).and_then(|i| one.acceleration[axis].get(i)) else {
            continue;
        };
        let up = if axis == 1 { 1.0 } else { 0.0 };
        let needed = up + acceleration / one.blocks.recording.meta.gravity().max(f64::MIN_POSITIVE);
        let given = known[number - 1].map_or(0.0, |weight_n| weight_n * needed);
        for (k, column) in columns[..blocks].iter_mut().enumerate() {
            column.push(if k + 1 == number && known[k].is_none() { needed } else { 0.0 });
        }
        for (k, column) in columns[blocks..].iter_mut().enumerate() {
            // Beside free weights, a constant would leave only the accelerations to determine them.
            let is_open = axis == 1 && known.iter().any(Option::is_none);
            column.push(f64::from(u8::from(k == axis && !is_open)));
        }
        y.push(rows.force_n(row) - given);
    }
    left_of_fit(columns, &y)
}
