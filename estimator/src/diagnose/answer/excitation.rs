//! Causes that the motion of a recording does not excite.

use crate::diagnose::contract::{Alternative, Cause, Diagnosis, NotExcited};
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::hypotheses::{backlash, force_gain, friction_asymmetry, hysteresis, length_scale};
use crate::diagnose::selection::comparison::Study;
use haptics::law::entries;

/// Causes that this recording does not show.
pub fn unseen(track: &Track, study: &Study, causes: &[Cause], alternatives: &[Alternative]) -> Vec<NotExcited> {
    let mut found = without_reversals(track, causes);
    let hidden = not_excited(study, &study.picks());
    let more: Vec<NotExcited> = hidden.into_iter().filter(|h| found.iter().all(|n| n.id != h.id)).collect();
    found.extend(more);
    // A rival of a named cause was seen, though not separated from it.
    found.retain(|n| alternatives.iter().all(|a| a.id != n.id));
    found
}

/// Causes whose effect this motion would hide in the noise.
fn not_excited(study: &Study, picks: &[usize]) -> Vec<NotExcited> {
    let mut found = Vec::new();
    for entry in entries() {
        let of: Vec<usize> = (0..study.candidates.len()).filter(|c| study.candidates[*c].id == entry.id).collect();
        if of.is_empty() || picks.iter().any(|p| study.candidates[*p].id == entry.id) {
            continue;
        }
        let rows = study.system.rows;
        let score = |c: &usize| study.system.distinct(*c, picks) * rows - study.candidates[*c].cost * rows.ln();
        let best = of.iter().map(score).fold(f64::NEG_INFINITY, f64::max);
        if best < study.rules.visible {
            let why = entry.reveals.trim_end_matches('.');
            found.push(NotExcited {
                id: entry.id.to_owned(),
                why: format!("this motion hides it behind the model's own terms; {}", lower(why)),
            });
        }
    }
    found
}

/// Causes that act at reversals alone, for a motion without any.
fn without_reversals(track: &Track, causes: &[Cause]) -> Vec<NotExcited> {
    if !track.goes_one_way() {
        return Vec::new();
    }
    let said = |id: &str| causes.iter().any(|c| c.id == id);
    // Along one coordinate, friction by direction then equals dry friction.
    let by_direction = (!track.planar).then_some(friction_asymmetry::ID);
    let hidden = [backlash::ID, hysteresis::ID].into_iter().chain(by_direction).filter(|id| !said(id));
    hidden
        .map(|id| NotExcited {
            id: id.to_owned(),
            why: "no reversal in the recording; move to and fro, also in short strokes".to_owned(),
        })
        .collect()
}

/// Causes that no motion shows unless a quantity is known. `weight`, `length`: true if one is known.
pub fn without_known(found: &mut Diagnosis, weight: bool, length: bool) {
    let hidden = [
        (force_gain::ID, weight, "no weight is known; state one in the sidecar, or hang one on"),
        (
            length_scale::ID,
            length,
            "no length is known, so a factor of all lengths cannot show; state radius_m in the sidecar",
        ),
    ];
    for (id, _, why) in hidden.into_iter().filter(|(_, known, _)| !known) {
        let said = found.causes.iter().any(|c| c.id == id)
            || found.alternatives.iter().any(|a| a.id == id)
            || found.not_excited.iter().any(|n| n.id == id);
        if !said {
            found.not_excited.push(NotExcited { id: id.to_owned(), why: why.to_owned() });
            found.passed_over.retain(|p| p.id != id);
        }
    }
}

fn lower(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |c| c.to_lowercase().chain(letters).collect())
}
