//! Circle and give of the pads, from the radius residual.

use super::signals::Held;
use crate::identify::limits::SIGNIFICANT;
use crate::regression::bootstrap::block_bootstrap;
use crate::regression::linear::{Values, least_squares, least_squares_values};
use foundation::estimate::EstimateError;
use foundation::signal::task::half_width;
use haptics::Vec2;

/// Circle and give of the pads.
pub(crate) struct Geometry {
    pub(crate) center_m: Vec2,
    pub(crate) radius_m: f64,
    /// Displacement of the tips against the handle per force, x and y, m/N.
    pub(crate) give_m_per_n: Vec2,
    /// Its standard errors, m/N.
    pub(crate) give_errors: Vec2,
    /// Standard errors of centre x, centre y, radius, m.
    pub(crate) errors_m: [f64; 3],
    /// The errors of centre, radius and gives by resampling; `None` where the turning is too short.
    pub(crate) resampled: Option<Drawn>,
    /// Radial stiffness from one common give.
    pub(crate) stiffness: Option<Stiffness>,
    pub(crate) rms_m: f64,
}

/// Standard errors by resampling, as in [`Geometry`].
#[derive(Clone, Copy)]
pub(crate) struct Drawn {
    pub(crate) errors_m: [f64; 3],
    pub(crate) give_errors: Vec2,
}

/// Radial stiffness, N/m, with its standard error by covariance and by resampling.
#[derive(Clone, Copy)]
pub(crate) struct Stiffness {
    pub(crate) n_m: f64,
    pub(crate) error: f64,
    pub(crate) resampled: Option<f64>,
}

/// Circle through the positions: Kåsa's linear fit as a start, then Gauss–Newton on the radius residual with the pads' give.
pub(crate) fn geometry(held: &Held) -> Result<Geometry, EstimateError> {
    // Smoothed samples closer than half their window say nothing new.
    let rows: Vec<usize> = held.turning.iter().copied().step_by(half_width(&held.time_s)).collect();
    let points: Vec<Vec2> = rows.iter().map(|i| held.position()[*i]).collect();
    let forces: Vec<Vec2> = rows.iter().map(|i| held.force[*i]).collect();
    let mut center = kasa(&points)?;
    let mut give = [true, true];
    let mut solved = None;
    for _ in 0..12 {
        let (fit, columns, places) = radius_fit(&points, &forces, center, give)?;
        let step = Vec2::new(fit.values[1], fit.values[2]);
        center += step;
        // A give stays in the fit even if it is small. Without it its effect on the centre would be hidden, because the
        // steady part of the load (the weight) moves the tips as a shifted centre would.
        let keep = |k: usize| places[k].is_some_and(|j| fit.identified[j]);
        let next = [give[0] && keep(0), give[1] && keep(1)];
        let settled = step.norm() < 1e-9 && next == give;
        give = next;
        solved = Some((fit, columns, places));
        if settled {
            break;
        }
    }
    let Some((fit, columns, places)) = solved else {
        return Err(EstimateError::Other("no circle was fitted".to_owned()));
    };
    // Only the last step's errors are asked for.
    let fit = fit.with_errors(&columns, None);
    let radius: Vec<f64> = points.iter().map(|p| (p - center).norm()).collect();
    let drawn = block_bootstrap(&columns, &radius, None, &fit);
    let value = |k: usize| places[k].map_or(0.0, |j| fit.values[j]);
    let error = |k: usize| places[k].map_or(0.0, |j| fit.std_errors[j]);
    Ok(Geometry {
        center_m: center,
        radius_m: fit.values[0],
        give_m_per_n: Vec2::new(value(0), value(1)),
        give_errors: Vec2::new(error(0), error(1)),
        errors_m: [fit.std_errors[1], fit.std_errors[2], fit.std_errors[0]],
        resampled: drawn.map(|drawn| {
            let give = |k: usize| places[k].map_or(0.0, |j| drawn[j]);
            Drawn { errors_m: [drawn[1], drawn[2], drawn[0]], give_errors: Vec2::new(give(0), give(1)) }
        }),
        stiffness: common_stiffness(&points, &forces, center)?,
        rms_m: fit.rms,
    })
}

/// Centre by Kåsa (1976): |p|² = 2 c·p + const is linear.
fn kasa(points: &[Vec2]) -> Result<Vec2, EstimateError> {
    let mean = points.iter().sum::<Vec2>() / points.len() as f64;
    let columns = vec![
        points.iter().map(|p| 2.0 * (p - mean).x).collect(),
        points.iter().map(|p| 2.0 * (p - mean).y).collect(),
        vec![1.0; points.len()],
    ];
    let squares: Vec<f64> = points.iter().map(|p| (p - mean).norm_squared()).collect();
    let fit = least_squares_values(&columns, &squares, None)?;
    Ok(mean + Vec2::new(fit.values[0], fit.values[1]))
}

/// A fit, its columns, and which of them carry the give along x and along y.
type RadiusFit = (Values, Vec<Vec<f64>>, [Option<usize>; 2]);

/// Linearised radius residual at `center`: columns 1, cos θ, sin θ and the wanted gives.
fn radius_fit(points: &[Vec2], forces: &[Vec2], center: Vec2, give: [bool; 2]) -> Result<RadiusFit, EstimateError> {
    let outward: Vec<Vec2> = points.iter().map(|p| (p - center).normalize()).collect();
    let radius: Vec<f64> = points.iter().map(|p| (p - center).norm()).collect();
    let mut columns =
        vec![vec![1.0; points.len()], outward.iter().map(|n| n.x).collect(), outward.iter().map(|n| n.y).collect()];
    let mut place = [None; 2];
    for (k, wanted) in give.into_iter().enumerate() {
        if wanted {
            place[k] = Some(columns.len());
            columns.push(outward.iter().zip(forces).map(|(n, f)| n[k] * f[k]).collect());
        }
    }
    Ok((least_squares_values(&columns, &radius, None)?, columns, place))
}

/// Radial stiffness if the give is the same in all directions: r = R + Fn/k.
fn common_stiffness(points: &[Vec2], forces: &[Vec2], center: Vec2) -> Result<Option<Stiffness>, EstimateError> {
    let outward: Vec<Vec2> = points.iter().map(|p| (p - center).normalize()).collect();
    let radius: Vec<f64> = points.iter().map(|p| (p - center).norm()).collect();
    let columns = vec![
        vec![1.0; points.len()],
        outward.iter().map(|n| n.x).collect(),
        outward.iter().map(|n| n.y).collect(),
        outward.iter().zip(forces).map(|(n, f)| n.dot(f)).collect(),
    ];
    let fit = least_squares(&columns, &radius, None)?;
    let (give, error) = (fit.values[3], fit.std_errors[3]);
    let of = |error: f64| error / (give * give);
    Ok((fit.identified[3] && give > SIGNIFICANT * error).then(|| Stiffness {
        n_m: 1.0 / give,
        error: of(error),
        resampled: block_bootstrap(&columns, &radius, None, &fit).map(|drawn| of(drawn[3])),
    }))
}
