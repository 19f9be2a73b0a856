// The table's light map: how much of the key light reaches each place of its top. Small, whatever the picture's size.

struct TableLightOut {
    @builtin(position) clip: vec4<f32>,
    // 0 to 1 along x and z of the table.
    @location(0) share: vec2<f32>,
};

@vertex
fn vs_table_light(@builtin(vertex_index) vertex: u32) -> TableLightOut {
    let share = vec2(f32(vertex & 1u), f32(vertex >> 1u));
    var out: TableLightOut;
    out.clip = vec4(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.0, 1.0);
    out.share = share;
    return out;
}

@fragment
fn fs_table_light(in: TableLightOut) -> @location(0) vec4<f32> {
    let xz = (2.0 * in.share - 1.0) * globals.table.zw + vec2(0.0, globals.shadow.w);
    return vec4(light_on_table(vec3(xz.x, globals.table.x, xz.y)), 0.0, 0.0, 1.0);
}
