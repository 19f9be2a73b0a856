// Shared by every shader of the scene.

struct Globals {
    clip_from_world: mat4x4<f32>,
    // Viewer: xyz position (w = 1) or direction towards the viewer (w = 0).
    eye: vec4<f32>,
    // Width, height in pixels; their inverses.
    viewport: vec4<f32>,
    background_top: vec4<f32>,
    background_bottom: vec4<f32>,
    // Added to the background; w: centre height in clip space.
    glow: vec4<f32>,
    // Table grid, display colour and strength.
    grid: vec4<f32>,
    // Shadow colour; w: z of the middle of the table (m).
    shadow: vec4<f32>,
    // x: table height (m); y: darkening of solids close to it; z, w: half extents of the table top along x and z (m).
    table: vec4<f32>,
    // From the world to the key light's map: x, y from 0 to 1 (y down), z from 0 at the light to 1.
    map_from_world: mat4x4<f32>,
    // Texels of the map's side, size of a texel (m), depth of its box (m), width of the light.
    map: vec4<f32>,
    // Unit vector towards the key light; w: how dark the table is where no sky is seen.
    key: vec4<f32>,
};

@group(0) @binding(0) var<uniform> globals: Globals;

// True when the target converts from linear light by itself.
override TARGET_IS_SRGB: bool = false;

fn to_target(display: vec3<f32>) -> vec3<f32> {
    if TARGET_IS_SRGB {
        return pow(display, vec3(2.2));
    }
    return display;
}

// Breaks up the bands of a gradient: a fixed pattern of half an 8-bit step.
fn dither(pixel: vec2<f32>) -> f32 {
    return (fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))) - 0.5) / 255.0;
}
