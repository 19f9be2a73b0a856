//! Drag of the air and spin, from the trajectories of all flights.

use crate::diagnose::contract::{Alternative, Cause, CauseParameter, Gain, parameter};
use crate::diagnose::data::limits::CERTAIN;
use crate::diagnose::hypotheses::{length_scale, quadratic_drag};
use crate::diagnose::selection::held_out_gain::chi_square_tail;
use estimation::identify::tossed::trajectory::{Air, CLEAR, Evidence};
use foundation::words::amount;
use haptics::law::Kind;

/// The causes that the trajectories show beside gravity.
pub fn causes(air: &Air) -> Vec<Cause> {
    let [drag, drag_error] = air.best.drag_per_m;
    let [scale, scale_error] = air.best.scale;
    let of_drag = format!(
        "the flights lose speed with its square: k/m = {drag:.3} 1/m leaves {} of {}",
        amount(air.best.rms_m, "m"),
        amount(air.drag.rms_without_m, "m")
    );
    let of_scale = format!(
        "beside the drag of the air the flights fall with {scale:.4} times gravity: lengths are recorded {:+.2} % off",
        100.0 * (scale - 1.0)
    );
    let drags = air.drag.is_clear() && drag > 0.0;
    let scales = air.scale.is_clear() && (scale - 1.0).abs() > CERTAIN * scale_error;
    let drag = drags.then(|| {
        let found = parameter("k/m", drag, drag_error, "1/m");
        named((&air.drag, air.best.rms_m), (quadratic_drag::ID, Kind::Plant), found, of_drag)
    });
    let scale = scales.then(|| {
        let found = parameter("epsilon", scale - 1.0, scale_error, "1");
        named((&air.scale, air.best.rms_m), (length_scale::ID, Kind::Instrument), found, of_scale)
    });
    drag.into_iter().chain(scale).collect()
}

/// A cause with its evidence and the residual RMS of the best model, m.
fn named((shown, rms_m): (&Evidence, f64), (id, kind): (&str, Kind), found: CauseParameter, evidence: String) -> Cause {
    Cause {
        id: id.to_owned(),
        kind,
        parameters: vec![found],
        p_value: chi_square_tail(shown.score.max(0.0), 1.0),
        posterior: 1.0 / (1.0 + (-0.5 * shown.score).exp()),
        standing: None,
        gain: Gain {
            heldout_rms_before: shown.rms_without_m,
            heldout_rms_after: rms_m,
            no_share: Some("all flights took part in the fit".to_owned()),
            unit: Some("m".to_owned()),
            ..Gain::default()
        },
        evidence,
    }
}

/// Drag in the place of a scale of the lengths that the parabolas show, with its probability; `None` if the scale is
/// beyond doubt beside drag and spin.
pub fn instead_of_scale(air: &Air) -> Option<Alternative> {
    let posterior = 1.0 / (1.0 + (0.5 * air.scale.score).exp());
    (air.scale.score <= CLEAR).then(|| Alternative {
        id: quadratic_drag::ID.to_owned(),
        instead_of: length_scale::ID.to_owned(),
        posterior,
        why: "drag of the air bends these flights as much; throw it farther".to_owned(),
    })
}

/// Sentence about a spin, for which the catalogue has no law.
pub fn spin(air: &Air) -> Option<String> {
    air.spin.is_clear().then(|| {
        format!(
            "the flights bend across their velocity, by up to {:.0} % of gravity: the body spins (Magnus force), which no law of the catalogue describes",
            100.0 * air.best.lift_share
        )
    })
}
