//! Noise of the motion that is not white: a position that was filtered, interpolated, or stamped with rounded times, or that
//! lost rows. The fastest differences show less of it than the filter lets through, and it attenuates the inertia (errors in
//! variables).

use super::parameters::{Known, Term};
use super::regress::System;
use super::signals::{CUTOFF_OVER_MOTION, DERIVATIVE_NOISE, Piece, Raw, pieces_below};
use super::swing::{motion_hz, rms};
use crate::identify::limits::SIGNIFICANT;
use haptics::law::Coordinate;
use std::slice;

/// The segments behind a lower filter, if the inertia is larger and surer there: half the cut-off, among halves of the usual one, at which its
/// relative error is the least. With them, a sentence about `name`. `None` if both inertias agree (Hausman 1978), or differ by less
/// than a filter's own share of noise.
///
/// Noise that attenuates the inertia leaves a residual, so that its error falls with it. Half the cut-off lets a thirtieth of the noise through.
pub fn behind_a_lower_filter(raw: &Raw, usual: &[Piece], known: &Known, name: &str) -> Option<(Vec<Piece>, String)> {
    let usual_hz = usual.iter().find(|piece| piece.accelerates)?.cutoff_hz;
    let speed = |pieces: &[Piece]| rms(pieces, |motion| motion.velocity);
    let passes = |pieces: &[Piece], share: f64| {
        share * usual_hz > CUTOFF_OVER_MOTION * motion_hz(pieces)
            && speed(pieces) > (1.0 - DERIVATIVE_NOISE) * speed(usual)
    };
    let at = |share: f64| {
        let pieces = pieces_below(slice::from_ref(raw), usual, share).ok().filter(|pieces| passes(pieces, share))?;
        let inertia = inertia(&pieces, known)?;
        Some((pieces, inertia))
    };
    // The usual cut-off is at most a hundred times the motion's frequency.
    let shares = std::iter::successors(Some(0.5), |share| Some(0.5 * share)).take(7);
    let mut below: Vec<_> = shares.map_while(at).collect();
    let relative = |[value, error]: [f64; 2]| error / value.max(f64::MIN_POSITIVE);
    let surest = (0..below.len()).min_by(|a, b| relative(below[*a].1).total_cmp(&relative(below[*b].1)))?;
    let of_usual = inertia(usual, known)?;
    let [attenuated, error] = of_usual;
    let [sure, own_error] = below[surest].1;
    let is_clear = sure - attenuated > (SIGNIFICANT * own_error.hypot(error)).max(DERIVATIVE_NOISE * sure);
    let is_surer = relative([sure, own_error]) < relative(of_usual);
    (is_clear && is_surer).then(|| {
        let (pieces, [inertia, _]) = below.swap_remove((surest + 1).min(below.len() - 1));
        let unit = if raw.coordinate == Coordinate::Linear { "kg" } else { "kg m²" };
        let said = format!(
            "the inertia of {name} is {attenuated:.4} {unit} behind the usual filter at {usual_hz:.1} Hz, and {inertia:.4} {unit} behind one at \
             {:.1} Hz, which the fit uses: the motion has noise there that its fastest differences do not show (it was filtered, interpolated, \
             stamped with rounded times, or lost rows), or the force is late",
            pieces[0].cutoff_hz
        );
        (pieces, said)
    })
}

/// Inertia beside friction and offset, and its standard error. Springs and gravity stay out: beside them, a slow motion shows any inertia.
fn inertia(pieces: &[Piece], known: &Known) -> Option<[f64; 2]> {
    let all = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset];
    let terms: Vec<Term> = all.into_iter().filter(|term| known.value(*term).is_none()).collect();
    let at = terms.iter().position(|term| *term == Term::Inertia)?;
    let fit = System::stack(pieces, &terms, known, Piece::applied_force).solve().ok()?;
    Some([fit.values[at], fit.std_errors[at]])
}
