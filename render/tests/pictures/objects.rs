//! Needle, membrane, barrel, cable and switch: what must be seen, and where.

use super::{HEIGHT, WIDTH, bare, changed, count, draw, headless, looks_like};
use haptics::Vec2;
use haptics::world::{Hole, State, World, presets, step};
use image::{Rgba, RgbaImage};
use render::{ColorRole, SolidRef, Theme, ViewOptions};

/// The pixel of a point of the plane, as [`bare`] sees it.
fn at(picture: &RgbaImage, point: Vec2) -> Rgba<u8> {
    let pixel = bare().camera.pixel_of(point, [WIDTH, HEIGHT]);
    *picture.get_pixel(pixel.x as u32, pixel.y as u32)
}

/// Nearly the same colour: the table shades what is close to it.
fn alike(a: Rgba<u8>, b: Rgba<u8>) -> bool {
    a.0.iter().zip(b.0).all(|(a, b)| a.abs_diff(b) < 18)
}

fn start(world: &World) -> State {
    State::new(world, [Vec2::new(-0.09, 0.0), Vec2::new(0.09, 0.0)])
}

/// The needle's cup without the needle.
fn cup() -> World {
    World { blocks: Vec::new(), ..presets::needle() }
}

#[test]
fn each_object_is_seen_and_so_is_its_ghost() {
    let Some(mut headless) = headless() else { return };
    for (name, world) in
        [("needle", presets::needle()), ("cup", cup()), ("barrel", presets::barrel()), ("switch", presets::switch())]
    {
        let state = start(&world);
        let bare_table = presets::table();
        let empty = draw(&mut headless, &bare_table, &start(&bare_table), &bare());
        let plain = draw(&mut headless, &world, &state, &bare());
        assert!(changed(&plain, &empty) > 500, "{name}");
        let mut ghost = state.clone();
        for body in &mut ghost.bodies {
            body.center_m += Vec2::new(0.012, 0.01);
        }
        ghost.switch.at_m = 0.004;
        ghost.membrane.active = Some(0);
        ghost.membrane.touched = 1;
        ghost.membrane.insertion_m = 0.003;
        let haunted = ViewOptions { ghost: Some(ghost), ..bare() };
        assert!(changed(&draw(&mut headless, &world, &state, &haunted), &plain) > 100, "ghost of {name}");
    }
}

#[test]
fn the_needle_ends_exactly_at_the_middle_of_its_lower_edge() {
    let Some(mut headless) = headless() else { return };
    let world = World { membrane: None, ..presets::needle() };
    let mut state = start(&world);
    for center in [Vec2::new(0.0, -0.08), Vec2::new(0.013, -0.05)] {
        state.bodies[0].center_m = center;
        let options =
            ViewOptions { camera: bare().camera.framing(glam::vec2(-0.02, -0.11), glam::vec2(0.03, -0.02)), ..bare() };
        let with = draw(&mut headless, &world, &state, &options);
        let mut gone = state.clone();
        gone.bodies[0].center_m.x = f64::NAN;
        let without = draw(&mut headless, &world, &gone, &options);
        let point = options.camera.pixel_of(center - Vec2::new(0.0, 0.5 * world.blocks[0].height_m), [WIDTH, HEIGHT]);
        // Its shadow lies on the table, further down.
        let table = options.camera.pixel_of(Vec2::new(0.0, -0.118), [WIDTH, HEIGHT]).y;
        let found = with.enumerate_pixels().filter(|(x, y, p)| *p != without.get_pixel(*x, *y) && (*y as f32) < table);
        let (x, y, _) = found.max_by_key(|(_, y, _)| *y).expect("the needle is seen");
        // The last pixel that a point covers is up to two above it.
        assert!((x as f32 - point.x).abs() < 2.0 && (-2.5..1.0).contains(&(y as f32 - point.y)), "{x}, {y}: {point}");
    }
}

#[test]
fn the_sheet_dents_where_it_is_pushed_and_keeps_its_holes() {
    let Some(mut headless) = headless() else { return };
    let world = cup();
    let middle = world.membrane.expect("there is one").center_m;
    let mut state = start(&world);
    let flat = draw(&mut headless, &world, &state, &bare());
    let paper = at(&flat, middle);
    let below = middle - Vec2::new(0.0, 0.004);
    assert!(!alike(at(&flat, below), paper), "nothing is cut there yet");

    state.membrane.touched = 1;
    state.membrane.active = Some(0);
    state.membrane.insertion_m = 0.004;
    let dented = draw(&mut headless, &world, &state, &bare());
    assert!(alike(at(&dented, below), paper), "the cut passes through the deepest place");

    state.membrane.active = None;
    let mut hole = Hole { along_m: -0.006, ..Hole::default() };
    hole.history.punctured = true;
    state.membrane.holes[0] = hole;
    let pierced = draw(&mut headless, &world, &state, &bare());
    let place = middle + Vec2::new(hole.along_m, 0.0);
    assert!(alike(at(&flat, place), paper));
    assert!(!alike(at(&pierced, place), paper), "a gap");
    assert!(alike(at(&pierced, middle), paper), "only there");
}

#[test]
fn a_whole_barrel_tells_nothing_about_its_content() {
    let Some(mut headless) = headless() else { return };
    let mut world = presets::barrel();
    let mut state = start(&world);
    let heavy = draw(&mut headless, &world, &state, &bare());
    world.blocks[0].content.as_mut().expect("it holds something").mass_kg = 0.02;
    assert_eq!(draw(&mut headless, &world, &state, &bare()), heavy);
    state.bodies[0].broken = true;
    assert!(changed(&draw(&mut headless, &world, &state, &bare()), &heavy) > 30, "a crack");
}

#[test]
fn the_puddle_grows_with_what_has_run_out() {
    let Some(mut headless) = headless() else { return };
    let world = presets::barrel();
    let mut state = start(&world);
    let options = ViewOptions { camera: render::Camera::workspace(), ..bare() };
    state.bodies[0].broken = true;
    let dry = draw(&mut headless, &world, &state, &options);
    let wet = [0.01, 0.04, 0.09, 0.15].map(|leaked_kg| {
        state.bodies[0].leaked_kg = leaked_kg;
        changed(&draw(&mut headless, &world, &state, &options), &dry)
    });
    assert!(wet.windows(2).all(|pair| pair[1] > pair[0] + 100), "{wet:?}");
}

#[test]
fn a_tipped_barrel_lies() {
    let Some(mut headless) = headless() else { return };
    let world = presets::barrel();
    let mut state = start(&world);
    state.bodies[0].center_m = Vec2::new(0.0, -0.08);
    let green = Theme::Light.color(ColorRole::Block(0));
    for (angle, along) in [(0.0, Vec2::new(0.0, 1.0)), (std::f64::consts::FRAC_PI_2, Vec2::new(1.0, 0.0))] {
        state.bodies[0].angle_rad = angle;
        let picture = draw(&mut headless, &world, &state, &bare());
        // It is 34 mm high and 26 mm wide.
        for end in [-1.0, 1.0] {
            let place = state.bodies[0].center_m + along * 0.014 * end;
            assert!(looks_like(at(&picture, place), green), "{angle} {end}: {:?}", at(&picture, place));
        }
        let beside = state.bodies[0].center_m + Vec2::new(along.y, along.x) * 0.0145;
        assert!(!looks_like(at(&picture, beside), green), "{angle}");
    }
}

#[test]
fn only_a_hard_pull_turns_the_cable_to_the_warning_colour() {
    let Some(mut headless) = headless() else { return };
    let world = presets::barrel();
    let mut state = start(&world);
    state.bodies[0].center_m = Vec2::new(-0.006, -0.09);
    let red = Theme::Light.color(ColorRole::Saturated);
    let weight_n = world.blocks[0].mass_kg * world.gravity_m_s2;
    let mut pulled = |cable_n: f64| {
        state.bodies[0].cable_n = cable_n;
        draw(&mut headless, &world, &state, &bare())
    };
    let (slack, taut, hard) = (pulled(0.0), pulled(0.5 * weight_n), pulled(3.5 * weight_n));
    assert!(changed(&slack, &taut) > 30, "slack hangs, taut is straight");
    assert_eq!(count(&taut, red), count(&slack, red));
    assert!(count(&hard, red) > count(&slack, red) + 30);
}

#[test]
fn the_knob_is_where_the_lever_puts_it() {
    let Some(mut headless) = headless() else { return };
    let world = presets::switch();
    let switch = world.switch.as_ref().expect("there is one");
    let green = Theme::Light.color(ColorRole::Block(0));
    let mut state = start(&world);
    for at_m in [-8e-3, 0.0, 5e-3] {
        state.switch.at_m = at_m;
        let picture = draw(&mut headless, &world, &state, &bare());
        let knob = switch.knob_in_world(at_m);
        for (x, y) in [(-0.8, 0.0), (0.8, 0.0), (0.0, 0.8), (0.0, -0.8)] {
            let place = knob + Vec2::new(x, y) * switch.knob_radius_m;
            assert!(looks_like(at(&picture, place), green), "inside at {x}, {y} of {at_m}");
        }
        for (x, y) in [(-1.2, 0.0), (1.2, 0.0), (0.0, 1.2)] {
            let place = knob + Vec2::new(x, y) * switch.knob_radius_m;
            assert!(!looks_like(at(&picture, place), green), "outside at {x}, {y} of {at_m}");
        }
    }
    let plain = draw(&mut headless, &world, &state, &bare());
    let lit = ViewOptions { highlight: Some(SolidRef::Knob), ..bare() };
    assert!(changed(&draw(&mut headless, &world, &state, &lit), &plain) > 100, "highlighted");
}

#[test]
fn a_simulated_puncture_is_drawn_with_its_point_below_the_sheet() {
    let Some(mut headless) = headless() else { return };
    let world = presets::needle();
    let sheet = world.membrane.expect("there is one").center_m;
    let mut state = start(&world);
    // A hand too strong for the paper: the needle is thrown onto it.
    state.bodies[0].velocity_m_s.y = -1.5;
    let input = state.input;
    for _ in 0..8 {
        step(&world, &mut state, &input, 1e-3);
    }
    assert!(state.membrane.holes[0].history.punctured && state.membrane.insertion_m > 0.003, "{:?}", state.membrane);
    let with = draw(&mut headless, &world, &state, &bare());
    state.bodies[0].center_m.x = f64::NAN;
    let without = draw(&mut headless, &world, &state, &bare());
    let below = sheet - Vec2::new(0.0, 0.5 * state.membrane.insertion_m);
    assert_ne!(at(&with, below), at(&without, below), "the shaft is seen through the cut");
}

#[test]
fn states_that_are_not_finite_do_not_stop_the_picture() {
    let Some(mut headless) = headless() else { return };
    for world in [presets::needle(), presets::barrel(), presets::switch()] {
        let mut state = start(&world);
        for body in &mut state.bodies {
            (body.center_m, body.angle_rad) = (Vec2::new(f64::NAN, f64::INFINITY), f64::NAN);
            (body.leaked_kg, body.broken, body.cable_n) = (f64::NAN, true, f64::NAN);
        }
        state.membrane.active = Some(7);
        state.membrane.touched = 100;
        state.membrane.insertion_m = f64::NAN;
        state.membrane.force_n = f64::INFINITY;
        state.switch.at_m = f64::NAN;
        state.time_s = f64::INFINITY;
        let options = ViewOptions { ghost: Some(state.clone()), ..bare() };
        let picture = draw(&mut headless, &world, &state, &options);
        assert_eq!(count(&picture, Theme::Light.color(ColorRole::Block(0))), 0);
    }
}
