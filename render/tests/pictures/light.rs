//! Shadows: where they must be, and only there; materials: patterns that move with the thing.

use super::thresholds::{SHADE, UNTOUCHED};
use super::{HEIGHT, WIDTH, bare, draw, headless};
use haptics::Vec2;
use haptics::world::{Block, Shape, State, World};
use image::RgbaImage;
use render::{Camera, Theme, ViewOptions};

const TABLE_M: f64 = -0.12;

/// A cube of 2 cm whose underside is `above_m` over the table, seen from above.
fn cube(above_m: f64) -> (World, State) {
    let mut world = World::empty("cube");
    world.floor.as_mut().expect("a table").height_m = TABLE_M;
    world.blocks = vec![Block::upright("cube", 0.04, 0.02, 0.02, 0.0, TABLE_M + above_m)];
    let state = State::new(&world, [Vec2::new(-0.09, 0.0), Vec2::new(0.09, 0.0)]);
    (world, state)
}

fn from_above(theme: Theme) -> ViewOptions {
    let camera = Camera { pitch_rad: 0.9, ..Camera::workspace() };
    ViewOptions { camera, theme, ..bare() }
}

/// Mean brightness around a place of the table, so that one grid line does not decide.
fn brightness(picture: &RgbaImage, options: &ViewOptions, x: f32, z: f32) -> f32 {
    let mut sum = 0.0;
    for (dx, dz) in [(0.0, 0.0), (0.0013, 0.0), (-0.0013, 0.0), (0.0, 0.0013), (0.0, -0.0013)] {
        let point = glam::Vec3::new(x + dx, TABLE_M as f32, z + dz);
        let pixel = options.camera.pixel(point, [WIDTH, HEIGHT]);
        let [r, g, b, _] = picture.get_pixel(pixel.x as u32, pixel.y as u32).0.map(f32::from);
        sum += r + g + b;
    }
    sum
}

/// The same place with the cube as a share of without.
fn dimmed(above_m: f64, theme: Theme, places: &[[f32; 2]]) -> Option<Vec<f32>> {
    let mut headless = headless()?;
    let (world, state) = cube(above_m);
    let mut gone = state.clone();
    gone.bodies[0].center_m.x = f64::NAN;
    let options = from_above(theme);
    let [with, without] = [&state, &gone].map(|state| draw(&mut headless, &world, state, &options));
    let share = |[x, z]: &[f32; 2]| brightness(&with, &options, *x, *z) / brightness(&without, &options, *x, *z);
    Some(places.iter().map(share).collect())
}

#[test]
fn a_standing_cube_casts_its_shadow_away_from_the_key_light_and_nowhere_else() {
    // The light comes from the upper left in front: the shadow lies to the right and behind.
    let shaded = [[0.0135, -0.004], [0.0150, -0.010]];
    let lit = [[-0.020, 0.010], [-0.022, -0.010], [0.0, 0.024], [0.035, 0.015], [0.045, -0.030]];
    for theme in [Theme::Light, Theme::Dark] {
        let Some(found) = dimmed(0.0, theme, &[shaded.as_slice(), lit.as_slice()].concat()) else { return };
        assert!(found[..2].iter().all(|share| *share < SHADE), "in the shadow, {theme:?}: {found:?}");
        assert!(found[2..].iter().all(|share| (share - 1.0).abs() < UNTOUCHED), "in the light, {theme:?}: {found:?}");
    }
}

#[test]
fn what_hides_the_sky_from_the_table_has_the_shape_of_the_thing() {
    // A drum and a box of the same width, seen where the key light comes from: no shadow lies there.
    let Some(mut headless) = headless() else { return };
    let half_m = 0.014_f32;
    let mut dimmed = |shape: Shape, place: [f32; 2]| {
        let (mut world, _) = cube(0.0);
        let width_m = 2.0 * f64::from(half_m);
        world.blocks = vec![Block { shape, ..Block::upright("thing", 0.04, width_m, 0.03, 0.0, TABLE_M) }];
        let state = State::new(&world, [Vec2::new(-0.09, 0.0), Vec2::new(0.09, 0.0)]);
        let mut gone = state.clone();
        gone.bodies[0].center_m.x = f64::NAN;
        let options = from_above(Theme::Light);
        let [with, without] = [&state, &gone].map(|state| draw(&mut headless, &world, state, &options));
        let at = |picture: &RgbaImage| brightness(picture, &options, place[0], place[1]);
        at(&with) / at(&without)
    };
    let beside = [-half_m - 0.0016, 0.0];
    let corner = [-0.9 * half_m, 0.9 * half_m];
    let drum = [dimmed(Shape::Barrel, beside), dimmed(Shape::Barrel, corner)];
    assert!(drum[0] < 0.97, "close beside it the drum hides some of the sky: {drum:?}");
    assert!(3.0 * (1.0 - drum[1]) < 1.0 - drum[0], "there is nothing of a drum in the corner of its box: {drum:?}");
    let wall = dimmed(Shape::Block, beside);
    assert!(wall < 0.97, "as beside a box: {wall}");
}

#[test]
fn a_lifted_cube_casts_a_shadow_that_lies_farther_away_and_is_softer() {
    // Along the light, the underside's right edge meets the table this much farther to the right for each metre of height.
    let slope = 0.4240 / 0.7067_f32;
    let depth = -0.5664 / 0.7067_f32;
    let edge = |above: f32| -> Vec<[f32; 2]> {
        // Across the shadow's right edge, at the height of its middle.
        (-12..=12_i8)
            .map(|i| [0.010 + (above + 0.010) * slope + f32::from(i) * 0.0005, (above + 0.010) * depth])
            .collect()
    };
    let width = |above: f32| {
        let shares = dimmed(f64::from(above), Theme::Light, &edge(above))?;
        Some(shares.iter().filter(|share| (0.80..0.97).contains(*share)).count())
    };
    let (Some(low), Some(high)) = (width(0.004), width(0.035)) else { return };
    assert!(high > low + 2, "{low} and {high} half millimetres of penumbra");
    let under = |above: f32| dimmed(f64::from(above), Theme::Light, &[[above * slope, above * depth]]).map(|s| s[0]);
    let (Some(near), Some(far)) = (under(0.030), under(0.045)) else { return };
    assert!(near < 0.9 && far < 0.9, "it follows the cube: {near}, {far}");
}

#[test]
fn one_body_shades_another() {
    let Some(mut headless) = headless() else { return };
    let (mut world, _) = cube(0.0);
    world.blocks.push(Block::upright("roof", 0.04, 0.06, 0.006, -0.012, TABLE_M + 0.03));
    let state = State::new(&world, [Vec2::new(-0.09, 0.0), Vec2::new(0.09, 0.0)]);
    let mut open = state.clone();
    open.bodies[1].center_m.x = f64::NAN;
    let options = ViewOptions { camera: Camera { pitch_rad: 0.35, ..Camera::workspace() }, ..bare() };
    let [roofed, open] = [&state, &open].map(|state| draw(&mut headless, &world, state, &options));
    // The top of the cube, seen below the roof.
    let place = options.camera.pixel(glam::Vec3::new(0.0, TABLE_M as f32 + 0.02, -0.004), [WIDTH, HEIGHT]);
    let green = |picture: &RgbaImage| f32::from(picture.get_pixel(place.x as u32, place.y as u32)[1]);
    assert!(green(&roofed) < 0.9 * green(&open), "{} and {}", green(&roofed), green(&open));
}

#[test]
fn a_turned_block_takes_its_grain_with_it() {
    let Some(mut headless) = headless() else { return };
    let (world, mut state) = cube(0.02);
    let camera = Camera { extent_m: glam::vec2(0.05, 0.04), ..Camera::front() };
    let center = state.bodies[0].center_m;
    let camera = Camera { target_m: glam::Vec3::new(center.x as f32, center.y as f32, 0.0), ..camera };
    let options = ViewOptions { camera, ..bare() };
    // How much brightness changes along one direction, against the other: grain is long in one of them.
    let mut roughness = |angle: f64| {
        state.bodies[0].angle_rad = angle;
        let picture = draw(&mut headless, &world, &state, &options);
        let at = |x: i32, y: i32| {
            let pixel = picture.get_pixel((WIDTH / 2).saturating_add_signed(x), (HEIGHT / 2).saturating_add_signed(y));
            i32::from(pixel[1])
        };
        let span = -40..40;
        let sum = |dx: i32, dy: i32| {
            span.clone()
                .flat_map(|y| (-40..40).map(move |x| (x, y)))
                .map(|(x, y)| (at(x, y) - at(x + dx, y + dy)).abs())
                .sum::<i32>()
        };
        f64::from(sum(0, 2)) / f64::from(sum(2, 0).max(1))
    };
    let upright = roughness(0.0);
    let turned = roughness(std::f64::consts::FRAC_PI_2);
    assert!(upright > 1.5 && turned < 1.0 / 1.5, "{upright} upright, {turned} on its side");
}

#[test]
fn what_lies_over_everything_stands_in_no_shadow() {
    let Some(mut headless) = headless() else { return };
    let (mut world, _) = cube(0.03);
    world.blocks[0].width_m = 0.05;
    let mut state = State::new(&world, [Vec2::new(0.005, TABLE_M + 0.01), Vec2::new(0.09, 0.0)]);
    state.tip_force_n = [Vec2::new(0.0, 2.0), Vec2::zeros()];
    let options = ViewOptions { show_forces: true, fingers: render::FingerStyle::Tool, ..from_above(Theme::Light) };
    let without_arrow = ViewOptions { show_forces: false, ..options.clone() };
    let mut gone = state.clone();
    gone.bodies[0].center_m.x = f64::NAN;
    let [a, b] = [&state, &gone].map(|state| {
        let on = draw(&mut headless, &world, state, &options);
        let off = draw(&mut headless, &world, state, &without_arrow);
        let arrow = on.enumerate_pixels().filter(|(x, y, p)| *p != off.get_pixel(*x, *y)).map(|(x, y, p)| (x, y, *p));
        arrow.collect::<Vec<_>>()
    });
    // Edges blend with what is behind them; the inside is the same.
    let same = a.iter().filter(|pixel| b.contains(pixel)).count();
    assert!(same * 10 > a.len() * 6 && a.len() > 60, "{same} of {}", a.len());
}

/// Light maps are kept while only the viewer moves: the picture must be that of a device that knows nothing of the one before.
#[test]
fn shadows_that_were_kept_are_those_that_would_be_made() {
    let (Some(mut kept), Some(mut fresh)) = (headless(), headless()) else { return };
    let (world, state) = cube(0.01);
    let (from_above, from_front) = (from_above(Theme::Light), bare());
    let first = draw(&mut kept, &world, &state, &from_front);
    let second = draw(&mut kept, &world, &state, &from_above);
    assert_ne!(first, second);
    assert_eq!(second, draw(&mut fresh, &world, &state, &from_above), "the viewer moved");
    let mut moved = state.clone();
    moved.bodies[0].center_m.x += 0.02;
    let third = draw(&mut kept, &world, &moved, &from_above);
    let mut fresh = headless().expect("there was one");
    assert_eq!(third, draw(&mut fresh, &world, &moved, &from_above), "the cube moved");
}
