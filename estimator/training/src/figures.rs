//! One number for every measure, as scores need them: the largest of several, the sum of counts.

use super::Measures;
use std::collections::BTreeMap;

/// The figures of an attempt by key of its definition. A quantity that was not measured is absent.
pub fn figures(measures: &Measures) -> BTreeMap<&'static str, f64> {
    let hand = &measures.hand;
    let mut figures = BTreeMap::from([
        ("duration_s", hand.duration_s),
        ("moving_s", hand.moving_s),
        ("path_length_m", hand.path_length_m.iter().sum()),
    ]);
    let optional = [
        ("peak_force_n", hand.peak_force_n),
        ("rms_force_n", hand.rms_force_n),
        ("over_limit_s", hand.over_limit_s),
        ("sparc", hand.sparc),
        ("log_dimensionless_jerk", hand.log_dimensionless_jerk),
    ];
    figures.extend(optional.into_iter().filter_map(|(key, value)| Some((key, value?))));
    let Some(course) = &measures.course else { return figures };
    if let Some(blocks) = &course.blocks {
        figures.extend([
            ("grasps", blocks.grasps.iter().sum::<usize>() as f64),
            ("drops", blocks.drops.len() as f64),
            ("slips", blocks.slips.len() as f64),
            ("stacks.offset_m", largest(blocks.stacks.iter().map(|s| s.offset_m))),
            ("stacks.tilt_rad", largest(blocks.stacks.iter().map(|s| s.tilt_rad))),
            ("carried_m", blocks.carried_m.iter().sum()),
            ("spilled_kg", blocks.spilled_kg),
        ]);
        figures.extend(blocks.at_rest_since_s.map(|since_s| ("at_rest_since_s", since_s)));
    }
    if let Some(crank) = &course.crank {
        figures.extend([
            ("reversals", crank.reversals as f64),
            ("off_tangent_j", crank.off_tangent_j),
            ("speed_variation", crank.speed_variation),
        ]);
    }
    if let Some(needle) = &course.needle {
        figures.extend([
            ("punctures.overshoot_m", largest(needle.punctures.iter().map(|p| p.overshoot_m))),
            ("punctures.along_m", largest(needle.punctures.iter().map(|p| p.along_m))),
            ("touched", needle.touched as f64),
            ("deepest_m", needle.deepest_m),
        ]);
    }
    if let Some(switch) = &course.switch {
        figures.extend([("fell_back", switch.fell_back as f64), ("stop_force_n", switch.stop_force_n)]);
    }
    figures
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}
