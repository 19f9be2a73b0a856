// Lines of constant width in pixels: each segment is a rectangle with round ends.

struct StrokeIn {
    @builtin(vertex_index) vertex: u32,
    @location(0) start_and_half_width: vec4<f32>,
    @location(1) end_and_dash: vec4<f32>,
    @location(2) color: vec4<f32>,
    @location(3) path: vec2<f32>,
};

struct StrokeOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
    // Along and across the segment, pixels.
    @location(1) @interpolate(linear) place: vec2<f32>,
    // Length in pixels, half width in pixels, path length at the start in dashes, dashes a pixel.
    @location(2) @interpolate(flat) measure: vec4<f32>,
};

@vertex
fn vs_stroke(in: StrokeIn) -> StrokeOut {
    let start = globals.clip_from_world * vec4(in.start_and_half_width.xyz, 1.0);
    let end = globals.clip_from_world * vec4(in.end_and_dash.xyz, 1.0);
    let to_pixels = 0.5 * globals.viewport.xy;
    let first = start.xy / start.w * to_pixels;
    let along = end.xy / end.w * to_pixels - first;
    let length = length(along);
    var direction = vec2(1.0, 0.0);
    if length > 1e-4 {
        direction = along / length;
    }
    let reach = in.start_and_half_width.w + 1.0;
    let is_end = (in.vertex & 1u) == 1u;
    let side = select(-1.0, 1.0, (in.vertex & 2u) == 2u);
    let a = select(-reach, length + reach, is_end);
    let pixel = first + direction * a + vec2(-direction.y, direction.x) * side * reach;
    let anchor = select(start, end, is_end);
    var out: StrokeOut;
    out.clip = vec4(pixel / to_pixels * anchor.w, anchor.z, anchor.w);
    out.color = in.color;
    out.place = vec2(a, side * reach);
    let dash = in.end_and_dash.w;
    var phase = vec2(0.25, 0.0);
    if dash > 0.0 {
        phase = vec2(in.path.x / dash, (in.path.y - in.path.x) / (dash * max(length, 1e-4)));
    }
    out.measure = vec4(length, in.start_and_half_width.w, phase);
    return out;
}

@fragment
fn fs_stroke(in: StrokeOut) -> @location(0) vec4<f32> {
    let beyond = max(max(-in.place.x, in.place.x - in.measure.x), 0.0);
    let inside = in.measure.y + 0.5 - length(vec2(beyond, in.place.y));
    let dash = fract(in.measure.z + in.place.x * in.measure.w);
    // Distance in pixels from the ends of the drawn half of the dash; without dashes it is far inside.
    let on = (0.25 - abs(dash - 0.25)) / max(in.measure.w, 1e-3) + 0.5;
    let cover = clamp(min(inside, on), 0.0, 1.0);
    return vec4(to_target(in.color.rgb), in.color.a * cover);
}
