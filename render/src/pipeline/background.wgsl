// A quiet gradient with a glow behind the hand; drawn last, only where nothing else is.

struct BackgroundOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) place: vec2<f32>,
};

@vertex
fn vs_background(@builtin(vertex_index) vertex: u32) -> BackgroundOut {
    let place = vec2(f32((vertex << 1u) & 2u), f32(vertex & 2u)) * 2.0 - 1.0;
    var out: BackgroundOut;
    out.clip = vec4(place, 1.0, 1.0);
    out.place = place;
    return out;
}

@fragment
fn fs_background(in: BackgroundOut) -> @location(0) vec4<f32> {
    let t = 0.5 + 0.5 * in.place.y;
    let base = mix(globals.background_bottom.rgb, globals.background_top.rgb, t);
    let from_glow = in.place - vec2(0.0, globals.glow.w);
    let halo = max(1.0 - 0.55 * dot(from_glow, from_glow), 0.0);
    let display = base + globals.glow.rgb * halo * halo + dither(in.clip.xy);
    return vec4(to_target(display), 1.0);
}
