//! What a recording could not have shown.

use super::geometry::Study;
use super::report::{Alternative, Cause, Diagnosis, NotExcited};
use super::track::Track;
use haptics::law::entries;

/// A cause of the noise's own size that would score less than this could not have been seen.
const VISIBLE: f64 = 10.0;

/// Who goes no larger a share of the way back goes one way: a hand trembles.
const ONE_WAY: f64 = 0.02;

/// What this recording could not have shown.
pub fn unseen(track: &Track, study: &Study, causes: &[Cause], alternatives: &[Alternative]) -> Vec<NotExcited> {
    let mut found = not_excited(study, &study.picks());
    found.extend(without_reversals(track, causes, &found));
    // What could stand in a cause's place was seen, if not told apart.
    found.retain(|n| alternatives.iter().all(|a| a.id != n.id));
    found
}

/// Causes that, at the size of the noise, this motion would hide.
fn not_excited(study: &Study, picks: &[usize]) -> Vec<NotExcited> {
    let mut found = Vec::new();
    for entry in entries() {
        let of: Vec<usize> = (0..study.candidates.len()).filter(|c| study.candidates[*c].id == entry.id).collect();
        if of.is_empty() || picks.iter().any(|p| study.candidates[*p].id == entry.id) {
            continue;
        }
        let best = of.iter().map(|c| study.system.distinct(*c, picks) * study.system.rows).fold(0.0, f64::max);
        if best < VISIBLE {
            let why = entry.reveals.trim_end_matches('.');
            found.push(NotExcited {
                id: entry.id.to_owned(),
                why: format!("this motion hides it behind the model's own terms; {}", lower(why)),
            });
        }
    }
    found
}

/// What happens at reversals alone, where there are none.
fn without_reversals(track: &Track, causes: &[Cause], already: &[NotExcited]) -> Vec<NotExcited> {
    let way = |side: f64| track.along().map(|i| (side * track.rows[i].motion.velocity).max(0.0)).sum::<f64>();
    let (forward, backward) = (way(1.0), way(-1.0));
    if forward.min(backward) > ONE_WAY * (forward + backward) {
        return Vec::new();
    }
    let said = |id: &str| causes.iter().any(|c| c.id == id) || already.iter().any(|n| n.id == id);
    let hidden = ["backlash", "hysteresis"].into_iter().filter(|id| !said(id));
    hidden
        .map(|id| NotExcited {
            id: id.to_owned(),
            why: "no reversal in the recording; move to and fro, also in short strokes".to_owned(),
        })
        .collect()
}

/// What no motion shows as long as nothing is known from elsewhere. `weight`, `length`: whether one is.
pub fn without_known(found: &mut Diagnosis, weight: bool, length: bool) {
    let hidden = [
        ("force-gain", weight, "no weight is known; state one in the sidecar, or hang one on"),
        (
            "length-scale",
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
