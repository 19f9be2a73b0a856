//! The parts that a tick is divided into, for the constraints of a body besides its contacts: numbers computed by hand.

use super::step::substeps;
use super::{World, presets};

const DT: f64 = 1e-3;

/// Least parts of a tick for ω h ≤ 0.5 and damping h / m ≤ 1.
fn least(stiffness_n_m: f64, damping_n_s_m: f64, mass_kg: f64) -> u32 {
    let rate = ((stiffness_n_m / mass_kg).sqrt() / 0.5).max(damping_n_s_m / mass_kg);
    (rate * DT).ceil() as u32
}

/// Parts before and after a change.
fn parts(mut world: World, change: impl FnOnce(&mut World)) -> [u32; 2] {
    let before = substeps(&world, DT);
    change(&mut world);
    [before, substeps(&world, DT)]
}

#[test]
fn a_stiff_or_strongly_damped_cable_takes_more_parts() {
    let barrel = presets::barrel();
    let full = &barrel.blocks[0];
    let mass_kg = full.mass_kg - full.content.expect("it has one").mass_kg;
    for (stiffness, damping) in [(1e6, 2.0), (600.0, 500.0)] {
        let [before, after] = parts(presets::barrel(), |world| {
            let cable = world.blocks[0].cable.as_mut().expect("it hangs on one");
            (cable.stiffness_n_m, cable.damping_n_s_m) = (stiffness, damping);
        });
        let needed = least(stiffness, damping, mass_kg);
        assert!(
            before < needed && after >= needed,
            "{stiffness} N/m, {damping} N s/m: {before}, {after}; {needed} needed"
        );
    }
}

#[test]
fn a_stiff_or_dragging_sheet_takes_more_parts() {
    type Change = fn(&mut World);
    let mass_kg = presets::needle().blocks[0].mass_kg;
    let cases: [(Change, u32); 3] = [
        (|world| world.membrane.as_mut().expect("a sheet").law.stiffness_n_m = 4e5, least(4e5, 0.0, mass_kg)),
        (|world| world.membrane.as_mut().expect("a sheet").side_stiffness_n_m = 4e5, least(4e5, 0.0, mass_kg)),
        (|world| world.membrane.as_mut().expect("a sheet").law.drag_n_s_m = 200.0, least(0.0, 200.0, mass_kg)),
    ];
    for (case, (change, needed)) in cases.into_iter().enumerate() {
        let [before, after] = parts(presets::needle(), change);
        assert!(before < needed && after >= needed, "case {case}: {before}, {after}; {needed} needed");
    }
}
