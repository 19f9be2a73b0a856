// A quiet gradient with a glow behind the hand. It varies slowly: computed at the corners of a coarse grid of cells, one
// instance a cell, and interpolated.

// Cells along x and y; `BACKGROUND_CELLS` of the renderer is their product.
const CELLS: vec2<u32> = vec2(16u, 12u);

struct BackgroundOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(linear) display: vec3<f32>,
};

@vertex
fn vs_background(@builtin(vertex_index) vertex: u32, @builtin(instance_index) cell: u32) -> BackgroundOut {
    let corner = vec2(cell % CELLS.x + (vertex & 1u), cell / CELLS.x + (vertex >> 1u));
    let place = vec2<f32>(corner) / vec2<f32>(CELLS) * 2.0 - 1.0;
    let t = 0.5 + 0.5 * place.y;
    let base = mix(globals.background_bottom.rgb, globals.background_top.rgb, t);
    let from_glow = place - vec2(0.0, globals.glow.w);
    let halo = max(1.0 - 0.55 * dot(from_glow, from_glow), 0.0);
    var out: BackgroundOut;
    out.clip = vec4(place, 1.0, 1.0);
    out.display = base + globals.glow.rgb * halo * halo;
    return out;
}

@fragment
fn fs_background(in: BackgroundOut) -> @location(0) vec4<f32> {
    return vec4(to_target(in.display + dither(in.clip.xy)), 1.0);
}
