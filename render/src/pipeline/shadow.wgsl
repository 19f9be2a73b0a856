// Soft shadows on the table: a blurred rectangle each.

struct ShadowIn {
    @builtin(vertex_index) vertex: u32,
    @location(0) center_and_half: vec4<f32>,
    @location(1) blur_and_alpha: vec2<f32>,
};

struct ShadowOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) half: vec2<f32>,
    @location(2) @interpolate(flat) blur_and_alpha: vec2<f32>,
};

@vertex
fn vs_shadow(in: ShadowIn) -> ShadowOut {
    let half = in.center_and_half.zw;
    let sign = vec2(select(-1.0, 1.0, (in.vertex & 1u) == 1u), select(1.0, -1.0, (in.vertex & 2u) == 2u));
    // Not beyond the edge of the table.
    let reach = vec2(globals.table.z, globals.table.w);
    let corner = in.center_and_half.xy + sign * (half + in.blur_and_alpha.x);
    let xz = clamp(corner, vec2(-reach.x, globals.shadow.w - reach.y), vec2(reach.x, globals.shadow.w + reach.y));
    var out: ShadowOut;
    out.clip = globals.clip_from_world * vec4(xz.x, globals.table.x + 0.0001, xz.y, 1.0);
    out.place = xz - in.center_and_half.xy;
    out.half = half;
    out.blur_and_alpha = in.blur_and_alpha;
    return out;
}

@fragment
fn fs_shadow(in: ShadowOut) -> @location(0) vec4<f32> {
    let blur = in.blur_and_alpha.x;
    let ramp = clamp((in.half - abs(in.place)) / (2.0 * blur) + 0.5, vec2(0.0), vec2(1.0));
    let soft = ramp * ramp * (3.0 - 2.0 * ramp);
    return vec4(to_target(globals.shadow.rgb), in.blur_and_alpha.y * soft.x * soft.y);
}
