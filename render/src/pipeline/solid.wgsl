// Lit solids. Colours arrive with gamma 2 undone; the square root at the end brings them back.

struct SolidIn {
    @location(0) corner: vec3<f32>,
    @location(1) offset: vec3<f32>,
    @location(2) normal: vec3<f32>,
    @location(3) row_x: vec4<f32>,
    @location(4) row_y: vec4<f32>,
    @location(5) row_z: vec4<f32>,
    @location(6) half_and_gloss: vec4<f32>,
    @location(7) radius_and_unlit: vec4<f32>,
    @location(8) color: vec4<f32>,
    @location(9) inset: vec2<f32>,
};

struct SolidOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
    // Gloss, unlit part.
    @location(3) @interpolate(flat) material: vec2<f32>,
};

@vertex
fn vs_solid(in: SolidIn) -> SolidOut {
    let radius = in.radius_and_unlit.xyz;
    let rim = vec3(in.inset * radius.z, 0.0);
    let local = vec4(in.corner * in.half_and_gloss.xyz + in.offset * radius + rim, 1.0);
    let world = vec3(dot(in.row_x, local), dot(in.row_y, local), dot(in.row_z, local));
    var out: SolidOut;
    out.clip = globals.clip_from_world * vec4(world, 1.0);
    out.world = world;
    out.normal = vec3(dot(in.row_x.xyz, in.normal), dot(in.row_y.xyz, in.normal), dot(in.row_z.xyz, in.normal));
    out.color = in.color;
    out.material = vec2(in.half_and_gloss.w, in.radius_and_unlit.w);
    return out;
}

// A key light from the upper left, a fill light from the right, a sky that is brighter than the ground.
const KEY: vec3<f32> = vec3(-0.4240, 0.7067, 0.5664);
const FILL: vec3<f32> = vec3(0.8082, 0.1155, 0.5774);

fn shade(in: SolidOut, occlusion: f32) -> vec3<f32> {
    let n = normalize(in.normal);
    let to_eye = normalize(globals.eye.xyz - in.world * globals.eye.w);
    let key = max(dot(n, KEY), 0.0);
    let fill = max(dot(n, FILL), 0.0);
    let sky = 0.36 + 0.16 * n.y;
    let half_way = max(dot(n, normalize(KEY + to_eye)), 0.0);
    let h2 = half_way * half_way;
    let h8 = h2 * h2 * h2 * h2;
    let shine = in.material.x * (0.9 * h8 * h8 * h8 * h8 + 0.12 * h8);
    let edge = 1.0 - max(dot(n, to_eye), 0.0);
    let rim = in.material.x * 0.10 * edge * edge * edge;
    let light = (sky + 0.72 * key + 0.20 * fill) * occlusion;
    let lit = in.color.rgb * light + vec3(shine + rim) * occlusion;
    return mix(lit, in.color.rgb, in.material.y);
}

@fragment
fn fs_solid(in: SolidOut) -> @location(0) vec4<f32> {
    // The table keeps light away from what is close to it.
    let open = clamp((in.world.y - globals.table.x) * 70.0 + 0.15, 0.0, 1.0);
    let occlusion = 1.0 - globals.table.y * (1.0 - open) * (1.0 - open);
    return vec4(to_target(sqrt(shade(in, occlusion))), in.color.a);
}

// Depth only: the colour is masked out.
@fragment
fn fs_depth() -> @location(0) vec4<f32> {
    return vec4(0.0);
}

// One line of the table's grid, 0 to 1, about one pixel wide whatever the distance.
fn grid_lines(position: vec2<f32>, pitch: f32) -> f32 {
    let cell = position / pitch;
    let width = fwidth(cell);
    let distance = abs(fract(cell - 0.5) - 0.5) / max(width, vec2(1e-6));
    let line = clamp(vec2(1.15) - distance, vec2(0.0), vec2(1.0));
    // Lines closer than some pixels would flicker: let them go.
    let visible = clamp(vec2(1.4) - 4.0 * width, vec2(0.0), vec2(1.0));
    return max(line.x * visible.x, line.y * visible.y);
}

@fragment
fn fs_table(in: SolidOut) -> @location(0) vec4<f32> {
    let lit = sqrt(shade(in, 1.0));
    let lines = max(0.55 * grid_lines(in.world.xz, 0.01), grid_lines(in.world.xz, 0.05));
    let margin = min(globals.table.z - abs(in.world.x), globals.table.w - abs(in.world.z - globals.shadow.w));
    let inside = clamp(margin * 250.0, 0.0, 1.0);
    let strength = globals.grid.a * lines * inside * clamp(in.normal.y * 4.0 - 3.0, 0.0, 1.0);
    return vec4(to_target(mix(lit, globals.grid.rgb, strength)), 1.0);
}
