// Copies the finished picture into the current viewport.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var picture_sampler: sampler;

override TARGET_IS_SRGB: bool = false;

struct BlitOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
};

@vertex
fn vs_blit(@builtin(vertex_index) vertex: u32) -> BlitOut {
    let uv = vec2(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    var out: BlitOut;
    out.clip = vec4(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0);
    out.uv = uv;
    return out;
}

@fragment
fn fs_blit(in: BlitOut) -> @location(0) vec4<f32> {
    let display = textureSampleLevel(picture, picture_sampler, in.uv, 0.0);
    if TARGET_IS_SRGB {
        return vec4(pow(display.rgb, vec3(2.2)), display.a);
    }
    return display;
}
