//! From the world to pixels and back.

// wgpu's clip space is DirectX's: y up, depth 0 to 1.
use glam::camera::rh::{
    proj::directx::{orthographic, perspective},
    view::look_at_mat4,
};
use glam::{Mat4, Vec2, Vec3};

/// Field of view of the perspective camera, rad: a long lens, so that lengths in the plane stay comparable.
const FOV_Y_RAD: f32 = 0.34;

/// Effect of depth on size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Like the eye.
    Perspective,
    /// True to scale; with yaw and pitch 0 the plane is seen straight on.
    Orthographic,
}

/// Position of the viewer: looks at `target` from yaw and pitch and sees at least `extent_m` around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Effect of depth on size.
    pub projection: Projection,
    /// The point in the middle of the picture, world, m.
    pub target_m: Vec3,
    /// Turn about the vertical, rad; positive: the viewer stands to the right.
    pub yaw_rad: f32,
    /// Height of the viewpoint as an angle, rad; positive: from above.
    pub pitch_rad: f32,
    /// Width and height at the target that any picture shape shows in full, m.
    pub extent_m: Vec2,
}

impl Default for Camera {
    fn default() -> Self {
        Self::hand()
    }
}

impl Camera {
    /// The whole default hand with its table, slightly from above.
    pub fn hand() -> Self {
        Self {
            projection: Projection::Perspective,
            target_m: Vec3::new(0.0, -0.057, 0.0),
            yaw_rad: 0.0,
            pitch_rad: 0.2,
            extent_m: Vec2::new(0.235, 0.188),
        }
    }

    /// Closer: fingertips, objects and table, where the work is.
    pub fn workspace() -> Self {
        Self { target_m: Vec3::new(0.0, -0.096, 0.0), extent_m: Vec2::new(0.14, 0.105), ..Self::hand() }
    }

    /// The plane straight on and true to scale.
    pub fn front() -> Self {
        Self { projection: Projection::Orthographic, pitch_rad: 0.0, ..Self::hand() }
    }

    /// The same direction, so that the rectangle from `low` to `high` (world, m) fills the picture with a margin.
    pub fn framing(self, low: Vec2, high: Vec2) -> Self {
        let extent_m = (high - low).abs().max(Vec2::splat(0.01)) * 1.15;
        Self { target_m: (0.5 * (low + high)).extend(0.0), extent_m, ..self }
    }

    /// Turns by a drag, rad; the pitch stays between slightly below and straight above.
    pub fn orbit(&mut self, yaw_rad: f32, pitch_rad: f32) {
        self.yaw_rad = (self.yaw_rad + yaw_rad).clamp(-1.3, 1.3);
        self.pitch_rad = (self.pitch_rad + pitch_rad).clamp(-0.15, 1.45);
    }

    /// Magnifies; 2 shows half as much. The result stays between 1 cm and 2 m.
    pub fn zoom(&mut self, factor: f32) {
        if factor.is_finite() && factor > 0.0 {
            let largest = self.extent_m.max_element();
            self.extent_m *= (1.0 / factor).clamp(0.01 / largest, 2.0 / largest);
        }
    }

    /// A camera on the way to another one, 0 here to 1 there; magnification changes evenly.
    pub fn toward(&self, other: &Self, share: f32) -> Self {
        let between = |a: f32, b: f32| a + (b - a) * share;
        let grown = |a: f32, b: f32| a * (b / a).powf(share);
        Self {
            projection: other.projection,
            target_m: self.target_m.lerp(other.target_m, share),
            yaw_rad: between(self.yaw_rad, other.yaw_rad),
            pitch_rad: between(self.pitch_rad, other.pitch_rad),
            extent_m: Vec2::new(grown(self.extent_m.x, other.extent_m.x), grown(self.extent_m.y, other.extent_m.y)),
        }
    }

    /// Difference of two cameras, as a share of the visible extent and in radians, whichever is most.
    pub fn apart(&self, other: &Self) -> f32 {
        let shown = other.extent_m.max_element();
        let moved = self.target_m.distance(other.target_m) / shown;
        let magnified = (self.extent_m - other.extent_m).abs().max_element() / shown;
        let turned = (self.yaw_rad - other.yaw_rad).abs().max((self.pitch_rad - other.pitch_rad).abs());
        moved.max(magnified).max(turned)
    }

    /// Moves the target so that the picture follows a drag of `pixels` (x right, y down).
    pub fn pan(&mut self, pixels: Vec2, size: [u32; 2]) {
        let metres = pixels / self.pixels_per_metre(size);
        let right = Vec3::new(self.yaw_rad.cos(), 0.0, -self.yaw_rad.sin());
        self.target_m += -right * metres.x + Vec3::Y * metres.y;
    }

    /// Scale at the target.
    pub fn pixels_per_metre(&self, size: [u32; 2]) -> f32 {
        size[1].max(1) as f32 / self.visible_height_m(size)
    }

    /// The position of the viewer, world, m.
    pub fn eye_m(&self, size: [u32; 2]) -> Vec3 {
        self.target_m + self.backwards() * self.distance_m(size)
    }

    /// Unit vector from the target to the viewer.
    pub fn backwards(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw_rad.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch_rad.sin_cos();
        Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch)
    }

    /// World to clip space (wgpu: y up, depth 0 near to 1 far).
    pub fn clip_from_world(&self, size: [u32; 2]) -> Mat4 {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let distance = self.distance_m(size);
        // The scene is at most some decimetres deep; a tight range keeps the depth buffer sharp.
        let (near, far) = ((distance - 0.6).max(0.05 * distance), distance + 0.9);
        let view = look_at_mat4(self.eye_m(size), self.target_m, Vec3::Y);
        let clip_from_view = match self.projection {
            Projection::Perspective => perspective(FOV_Y_RAD, aspect, near, far),
            Projection::Orthographic => {
                let half = 0.5 * self.visible_height_m(size);
                orthographic(-half * aspect, half * aspect, -half, half, near, far)
            }
        };
        clip_from_view * view
    }

    /// Pixel of a world point: x right, y down from the upper left corner.
    pub fn pixel(&self, point_in_world: Vec3, size: [u32; 2]) -> Vec2 {
        let clip = self.clip_from_world(size).project_point3(point_in_world);
        Vec2::new(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y) * Vec2::new(size[0] as f32, size[1] as f32)
    }

    /// Pixel of a point of the world's plane: for labels and for tests.
    pub fn pixel_of(&self, point_in_world: haptics::Vec2, size: [u32; 2]) -> Vec2 {
        self.pixel(crate::coordinates::vec2(point_in_world).extend(0.0), size)
    }

    /// The point of the world's plane (z = 0) under a pixel: where the mouse is. `None` when looking along the plane.
    pub fn point_in_plane(&self, pixel: Vec2, size: [u32; 2]) -> Option<haptics::Vec2> {
        let extent = Vec2::new(size[0].max(1) as f32, size[1].max(1) as f32);
        let clip = Vec2::new(2.0 * pixel.x / extent.x - 1.0, 1.0 - 2.0 * pixel.y / extent.y);
        let world_from_clip = self.clip_from_world(size).inverse();
        let near = world_from_clip.project_point3(clip.extend(0.0));
        let far = world_from_clip.project_point3(clip.extend(1.0));
        let t = near.z / (near.z - far.z);
        let point = near + (far - near) * t;
        (t.is_finite() && point.is_finite()).then(|| haptics::Vec2::new(f64::from(point.x), f64::from(point.y)))
    }

    fn visible_height_m(&self, size: [u32; 2]) -> f32 {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        self.extent_m.y.max(self.extent_m.x / aspect)
    }

    fn distance_m(&self, size: [u32; 2]) -> f32 {
        match self.projection {
            Projection::Perspective => 0.5 * self.visible_height_m(size) / (0.5 * FOV_Y_RAD).tan(),
            Projection::Orthographic => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [1280, 720];

    #[test]
    fn the_target_is_in_the_middle() {
        for camera in [Camera::hand(), Camera::workspace(), Camera::front()] {
            assert!((camera.pixel(camera.target_m, SIZE) - Vec2::new(640.0, 360.0)).length() < 0.05);
        }
    }

    #[test]
    fn up_is_up_and_right_is_right() {
        let camera = Camera::default();
        let pixel = camera.pixel(camera.target_m + Vec3::new(0.01, 0.01, 0.0), SIZE);
        assert!(pixel.x > 640.0 && pixel.y < 360.0);
    }

    #[test]
    fn the_mouse_finds_the_point_it_points_at() {
        for camera in [Camera::hand(), Camera::front(), Camera { yaw_rad: 0.5, ..Camera::workspace() }] {
            let point = haptics::Vec2::new(0.013, -0.117);
            let found = camera.point_in_plane(camera.pixel_of(point, SIZE), SIZE).expect("not edge-on");
            assert!((found - point).norm() < 2e-6, "{found:?}");
        }
    }

    #[test]
    fn front_is_true_to_scale() {
        let camera = Camera::front();
        let a = camera.pixel(Vec3::new(0.0, -0.1, 0.02), SIZE);
        let b = camera.pixel(Vec3::new(0.01, -0.1, -0.05), SIZE);
        assert!((b - a - Vec2::new(0.01 * camera.pixels_per_metre(SIZE), 0.0)).length() < 1e-2);
    }

    #[test]
    fn a_narrow_picture_still_shows_the_width() {
        let camera = Camera::hand();
        let left = camera.pixel(camera.target_m - Vec3::X * 0.49 * camera.extent_m.x, [300, 900]);
        assert!(left.x > 0.0);
    }

    #[test]
    fn panning_follows_the_drag() {
        let mut camera = Camera::front();
        let before = camera.pixel(Vec3::ZERO, SIZE);
        camera.pan(Vec2::new(30.0, -12.0), SIZE);
        assert!((camera.pixel(Vec3::ZERO, SIZE) - before - Vec2::new(30.0, -12.0)).length() < 0.05);
    }
}
