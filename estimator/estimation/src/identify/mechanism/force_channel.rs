//! Defects of a force channel that the fit takes out: a step of its zero, a stretch that does not belong
//! to the motion, and the offset of a clock of its own.

use super::foreign_force::{self, Stretch};
use super::parameter_change::{self, Change};
use super::parameters::{Known, Term};
use super::regress::System;
use super::signals::Piece;
use super::zero_step::{self, OF_POWER, ZeroStep};
use crate::identify::limits::{LEAST_SEGMENT_ROWS, SIGNIFICANT};
use crate::zero_jumps;
use foundation::words::amount;
use haptics::law::Coordinate;
use haptics::recording::{CLOCK_OFFSET, FOREIGN_FORCE, Recording, TARE_STEP};

/// Notes the defects of a recording's force channel in its segments, unless the sidecar forbids it; a sentence about each.
pub fn take_defects_out(
    pieces: &mut [Piece],
    of: &Recording,
    (coordinate, known): (Coordinate, &Known),
) -> Vec<String> {
    if pieces.iter().any(|piece| piece.force.is_none()) {
        return Vec::new();
    }
    let is_linear = coordinate == Coordinate::Linear;
    let gravity: &[Term] = if is_linear { &[] } else { &[Term::GravitySine, Term::GravityCosine] };
    let all = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset].into_iter().chain(gravity.iter().copied());
    let mut terms: Vec<Term> = all.filter(|term| known.value(*term).is_none()).collect();
    let mut said = Vec::new();
    let change = parameter_change::change(pieces, &terms, known);
    // Two fits also describe a step or a stretch, and leave as much as these.
    let is_change = |rms: f64| change.is_some_and(|change| change.rms[1].powi(2) < (1.0 - OF_POWER) * rms.powi(2));
    let steps = zero_step::zero_steps(pieces, &terms, known);
    // A force that came and went is two steps, too.
    let is_stretch = |rms: f64| {
        let stretch = if steps.len() > 1 { foreign_force::stretch(pieces, &terms, known) } else { None };
        stretch.is_some_and(|stretch| rms.powi(2) > (1.0 - OF_POWER) * stretch.outside.powi(2))
    };
    let stepped = (!steps.is_empty()).then(|| zero_step::with_steps(&steps, pieces, &terms, known));
    if let Some((stepped, _)) = stepped.filter(|(_, rms)| !is_change(*rms) && !is_stretch(*rms)) {
        if of.meta.repairs(TARE_STEP) {
            pieces.clone_from_slice(&stepped);
            terms.push(Term::ZeroStep);
        }
        said.push(jumps(&steps, of, is_linear));
    }
    // Near a step, its edge remains in the residual.
    if said.is_empty() {
        let stretch = foreign_force::stretch(pieces, &terms, known).filter(|stretch| !is_change(stretch.outside));
        said.extend(stretch.map(|stretch| leave_foreign_force_out(pieces, of, &stretch, is_linear)));
    }
    if said.is_empty() {
        said.extend(change.map(|change| changed(&change, &of.name, is_linear)));
    }
    let has_clocks = of.has_several_clocks();
    // On one clock, less than a sample is sampling; more than a period of the filter is no lag that its band shows.
    let least_s = of.rate_hz().map_or(0.0, f64::recip);
    let most_s = pieces.first().map_or(0.0, |piece| piece.cutoff_hz.recip());
    let is_told = |delay_s: f64| has_clocks || (least_s..most_s).contains(&delay_s.abs());
    if let Some((prompt, delay_s)) = without_delay(pieces, &terms, known).filter(|(_, delay_s)| is_told(*delay_s)) {
        if has_clocks && of.meta.repairs(CLOCK_OFFSET) {
            pieces.clone_from_slice(&prompt);
        }
        let order = if delay_s < 0.0 { "earlier" } else { "later" };
        said.push(format!(
            "the force of {} {}",
            of.name,
            lag(&amount(delay_s.abs(), "s"), order, has_clocks.then_some(of))
        ));
    }
    said
}

/// Words for steps of the zero.
fn jumps(steps: &[ZeroStep], of: &Recording, is_linear: bool) -> String {
    let unit = if is_linear { "N" } else { "N m" };
    let each = steps.iter().map(|step| format!("by {} at {:.2} s", amount(step.size, unit), step.time_s));
    format!(
        "the force of {} jumps {} and stays, as after a tare or a knock of its sensor; {}",
        of.name,
        each.collect::<Vec<_>>().join(" and "),
        zero_jumps::fate(of, TARE_STEP, if steps.len() > 1 { "staircase" } else { "step" })
    )
}

/// Leaves the stretch out in which the force does not belong to the motion, unless the sidecar forbids it; a sentence about it.
fn leave_foreign_force_out(pieces: &mut [Piece], of: &Recording, stretch: &Stretch, is_linear: bool) -> String {
    if of.meta.repairs(FOREIGN_FORCE) {
        foreign_force::leave_out(pieces, stretch);
    }
    let unit = if is_linear { "N" } else { "N m" };
    let [from_s, to_s] = stretch.time_s;
    format!(
        "from {from_s:.2} s to {to_s:.2} s, the residual of {} is {} RMS, and elsewhere {}: a hand or a stop acted there beside the \
         recorded force, or the sensor failed; {}",
        of.name,
        amount(stretch.inside, unit),
        amount(stretch.outside, unit),
        zero_jumps::fate(of, FOREIGN_FORCE, "stretch")
    )
}

/// Words for parameters that are not the same throughout.
fn changed(change: &Change, of: &str, is_linear: bool) -> String {
    let unit = if is_linear { "N" } else { "N m" };
    let [one, two] = change.rms.map(|rms| amount(rms, unit));
    let advice = "read the parts on their own, with \"windows\" in the sidecar";
    match change.gain {
        Some(gain) => format!(
            "from {:.2} s on, the force of {of} is {gain:.3} times the one that the motion before shows: the gain, unit or sign of its \
             sensor changed; {advice}",
            change.time_s
        ),
        None => format!(
            "the parameters of {of} change at about {:.2} s: one fit leaves a residual of {one} RMS, and two, before and after it, {two}: \
             the load, the mechanism or a sensor changed; {advice}",
            change.time_s
        ),
    }
}

/// Words for a lag. On one clock, only the diagnosis tells it from other causes. `clocks`: the recording, if it has several.
fn lag(size: &str, order: &str, clocks: Option<&Recording>) -> String {
    match clocks {
        Some(of) => {
            let fate = zero_jumps::fate(of, CLOCK_OFFSET, "lag");
            format!("is {size} {order} than the motion, and they have clocks of their own; {fate}")
        }
        None => format!(
            "seems {size} {order} than the motion; if it is, inertia and friction are off by more than their errors: run the \
             diagnosis, which tells a delay from other causes"
        ),
    }
}

/// The segments without the lag of the force behind the motion, and this lag, s. `None` if it takes less than half of the
/// residual's power. A spring takes part, because its force also differs from that of the other terms by a phase.
fn without_delay(pieces: &[Piece], terms: &[Term], known: &Known) -> Option<(Vec<Piece>, f64)> {
    let fit = |pieces: &[Piece], extra: &[Term]| {
        let terms: Vec<Term> = terms.iter().chain(extra).copied().collect();
        let system = System::stack(pieces, &terms, known, Piece::applied_force);
        if system.target.len() < LEAST_SEGMENT_ROWS { None } else { system.solve().ok() }
    };
    let (mut prompt, mut delay_s, mut left) = (pieces.to_vec(), 0.0, f64::INFINITY);
    // Gauss–Newton steps, because the rate of the force describes a small lag only. Ten of them settle a lag of a tenth of a
    // second in a slow motion.
    for _ in 0..10 {
        prompt = pieces.iter().map(|piece| piece.with_force_earlier(delay_s)).collect();
        let found = fit(&prompt, &[Term::Spring, Term::Delay])?;
        left = found.rms;
        let last = found.values.len() - 1;
        // The first step shows if there is a lag.
        if delay_s == 0.0 && found.values[last].abs() < SIGNIFICANT * found.std_errors[last] {
            return None;
        }
        if found.values[last].abs() < 0.01 * found.std_errors[last] {
            break;
        }
        delay_s += found.values[last];
    }
    let whole = fit(pieces, &[Term::Spring])?.rms;
    ((left / whole.max(f64::MIN_POSITIVE)).powi(2) <= 1.0 - OF_POWER).then_some((prompt, delay_s))
}
