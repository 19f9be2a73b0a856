//! Composes the draw data of a scene: its shapes, the numbers of the shaders, and the light that fits them.

use crate::camera::{Camera, Projection};
use crate::coordinates::vec2;
use crate::draw_data::{DrawData, Globals};
use crate::drawable;
use crate::light::{KEY, KeyLight};
use crate::scene::SceneView;
use crate::shape::Stroke;
use crate::theme::Theme;
use glam::{Mat4, Vec2, Vec4};

impl DrawData {
    /// Lists the shapes of `view` in a picture of `size` pixels.
    pub fn new(view: &SceneView<'_>, size: [u32; 2]) -> Self {
        let mut data = Self {
            globals: globals(view, size),
            size,
            solids: Vec::with_capacity(128),
            strokes: Vec::with_capacity(256),
            overlay_strokes: Vec::with_capacity(1024),
        };
        drawable::draw_scene(&mut data, view);
        data.solids.retain(|(_, _, solid)| solid.is_finite());
        data.strokes.retain(Stroke::is_finite);
        data.overlay_strokes.retain(Stroke::is_finite);
        data.solids.sort_by_key(|(layer, mesh, _)| (*layer, *mesh));
        data.set_light();
        data
    }

    /// Fits the key light's map around the shapes that cast shadows.
    fn set_light(&mut self) {
        let casters = self.solids.iter().filter(|(layer, _, _)| layer.casts_shadows());
        let light = KeyLight::around(casters.map(|(_, _, solid)| solid));
        (self.globals.map_from_world, self.globals.map) = (light.map_from_world, light.measures);
    }
}

fn globals(view: &SceneView<'_>, size: [u32; 2]) -> Globals {
    let camera = &view.options.camera;
    let palette = view.options.theme.palette();
    let [width, height] = size.map(|n| n.max(1) as f32);
    let hand = vec2(view.world.hand.workspace.center_m).extend(0.0);
    let glow_height = 1.0 - 2.0 * camera.pixel(hand, size).y / height;
    let table = drawable::table::extent(view.world);
    Globals {
        clip_from_world: camera.clip_from_world(size),
        eye: eye(camera, size),
        viewport: Vec4::new(width, height, 1.0 / width, 1.0 / height),
        background_top: palette.background_top.display(),
        background_bottom: palette.background_bottom.display(),
        glow: palette.glow.rgb.extend(glow_height.clamp(-1.0, 1.0)),
        grid: palette.grid.rgb.extend(grid_strength(view.options.theme)),
        shadow: palette.shadow.rgb.extend(table.center_z),
        table: table.top.map_or(Vec4::new(-1e3, 0.0, 1.0, 1.0), |top| {
            let Vec2 { x, y } = table.half;
            Vec4::new(top, 0.45, x, y)
        }),
        map_from_world: Mat4::IDENTITY,
        map: Vec4::ZERO,
        key: KEY.extend(palette.shadow.alpha),
    }
}

fn eye(camera: &Camera, size: [u32; 2]) -> Vec4 {
    match camera.projection {
        Projection::Perspective => camera.eye_m(size).extend(1.0),
        Projection::Orthographic => camera.backwards().extend(0.0),
    }
}

fn grid_strength(theme: Theme) -> f32 {
    match theme {
        Theme::Light => 0.55,
        Theme::Dark => 0.45,
    }
}
