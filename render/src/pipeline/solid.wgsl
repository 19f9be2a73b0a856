// Lit solids. Colours arrive with gamma 2 undone; the square root at the end brings them back.

// The table's light map.
@group(2) @binding(0) var table_light: texture_2d<f32>;
@group(2) @binding(1) var table_light_sampler: sampler;
// How much of the sky is hidden from it.
@group(2) @binding(2) var table_sky: texture_2d<f32>;

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
    @location(10) material: u32,
};

struct SolidOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
    // Gloss, unlit part.
    @location(3) @interpolate(flat) shine: vec2<f32>,
    // In the solid's own frame: patterns move with it.
    @location(4) local: vec3<f32>,
    @location(5) @interpolate(flat) material: u32,
};

fn local_of(in: SolidIn) -> vec4<f32> {
    let radius = in.radius_and_unlit.xyz;
    let rim = vec3(in.inset * radius.z, 0.0);
    return vec4(in.corner * in.half_and_gloss.xyz + in.offset * radius + rim, 1.0);
}

@vertex
fn vs_solid(in: SolidIn) -> SolidOut {
    let local = local_of(in);
    let world = vec3(dot(in.row_x, local), dot(in.row_y, local), dot(in.row_z, local));
    var out: SolidOut;
    out.clip = globals.clip_from_world * vec4(world, 1.0);
    out.world = world;
    out.normal = vec3(dot(in.row_x.xyz, in.normal), dot(in.row_y.xyz, in.normal), dot(in.row_z.xyz, in.normal));
    out.color = in.color;
    out.shine = vec2(in.half_and_gloss.w, in.radius_and_unlit.w);
    out.local = local.xyz;
    out.material = in.material;
    return out;
}

// As the key light sees it.
@vertex
fn vs_cast(in: SolidIn) -> @builtin(position) vec4<f32> {
    let local = local_of(in);
    let place = map_place(vec3(dot(in.row_x, local), dot(in.row_y, local), dot(in.row_z, local)));
    return vec4(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, place.z, 1.0);
}

@fragment
fn fs_cast(@builtin(position) clip: vec4<f32>) -> @location(0) vec4<f32> {
    return to_map(clip.z);
}

// What the underside map spans above the table, m.
const UNDERSIDES: f32 = 1.0;

struct UnderOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) height: f32,
};

// As the table sees it, looking straight up.
@vertex
fn vs_under(in: SolidIn) -> UnderOut {
    let local = local_of(in);
    let world = vec3(dot(in.row_x, local), dot(in.row_y, local), dot(in.row_z, local));
    let place = (world.xz - vec2(0.0, globals.shadow.w)) / globals.table.zw;
    var out: UnderOut;
    // What reaches into the table stands on it.
    out.height = max(world.y - globals.table.x, 0.0);
    out.clip = vec4(place.x, -place.y, min(out.height / UNDERSIDES, 1.0), 1.0);
    return out;
}

@fragment
fn fs_under(in: UnderOut) -> @location(0) vec4<f32> {
    return to_map(in.height / UNDERSIDES);
}

// A fill light from the right and a sky that is brighter than the ground join the key light.
const FILL: vec3<f32> = vec3(0.8082, 0.1155, 0.5774);

fn shade(in: SolidOut, look: Look, key_share: f32, occlusion: f32) -> vec3<f32> {
    let n = normalize(in.normal);
    let toward_key = globals.key.xyz;
    let to_eye = normalize(globals.eye.xyz - in.world * globals.eye.w);
    let facing = dot(n, toward_key);
    let key = max((facing + look.wrap) / (1.0 + look.wrap), 0.0) * key_share;
    let fill = max(dot(n, FILL), 0.0);
    let sky = 0.36 + 0.16 * n.y;
    let half_way = max(dot(n, normalize(toward_key + to_eye)), 0.0);
    let h2 = half_way * half_way;
    let h8 = h2 * h2 * h2 * h2;
    let gloss = look.gloss;
    let shine = gloss * (0.9 * h8 * h8 * h8 * h8 + 0.12 * h8) * (0.15 + 0.85 * key_share);
    let edge = 1.0 - max(dot(n, to_eye), 0.0);
    let rim = gloss * 0.10 * edge * edge * edge;
    let light = (sky + 0.72 * key + 0.20 * fill) * occlusion;
    let color = in.color.rgb * look.tint;
    let matt = color * light + vec3(shine + rim) * occlusion;
    
    let mirrored = color * studio(reflect(-to_eye, n), key_share) * (0.40 + 0.60 * light) + vec3(0.5 * shine * occlusion);
    let lit = mix(matt, mirrored, look.metal);
    return mix(lit, in.color.rgb, in.shine.y);
}

// What a polished surface mirrors: a bright ceiling, a darker horizon, a light floor, the key light's broad lamp.
fn studio(direction: vec3<f32>, key_share: f32) -> f32 {
    let up = direction.y;
    let ceiling = smoothstep(-0.15, 0.70, up);
    let floor = smoothstep(-0.1, -0.8, up);
    let toward = max(dot(direction, globals.key.xyz), 0.0);
    let lamp = smoothstep(0.78, 0.97, toward);
    return 0.74 + 0.55 * ceiling + 0.10 * floor + 0.75 * lamp * (0.25 + 0.75 * key_share);
}

// The table keeps light away from what is close to it.
fn openness(world: vec3<f32>) -> f32 {
    let open = clamp((world.y - globals.table.x) * 70.0 + 0.15, 0.0, 1.0);
    return 1.0 - globals.table.y * (1.0 - open) * (1.0 - open);
}

@fragment
fn fs_solid(in: SolidOut) -> @location(0) vec4<f32> {
    let look = look_of(in.material, in.local, in.shine.x);
    let key_share = light_on_solid(in.world, normalize(in.normal));
    return vec4(to_target(sqrt(shade(in, look, key_share, openness(in.world)))), in.color.a);
}

// What lies in front of everything stands in no shadow.
@fragment
fn fs_overlay(in: SolidOut) -> @location(0) vec4<f32> {
    let look = Look(1.0, in.shine.x, 0.0, 0.0);
    return vec4(to_target(sqrt(shade(in, look, 1.0, 1.0))), in.color.a);
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
    let share = 0.5 + 0.5 * (in.world.xz - vec2(0.0, globals.shadow.w)) / globals.table.zw;
    let key_share = textureSampleLevel(table_light, table_light_sampler, share, 0.0).x;
    let look = Look(1.0, in.shine.x, 0.0, 0.0);
    let lit = sqrt(shade(in, look, key_share, 1.0));
    let lines = max(0.55 * grid_lines(in.world.xz, 0.01), grid_lines(in.world.xz, 0.05));
    let margin = min(globals.table.z - abs(in.world.x), globals.table.w - abs(in.world.z - globals.shadow.w));
    let inside = clamp(margin * 250.0, 0.0, 1.0);
    let strength = globals.grid.a * lines * inside * clamp(in.normal.y * 4.0 - 3.0, 0.0, 1.0);
    let drawn = mix(lit, globals.grid.rgb * mix(0.75, 1.0, key_share), strength);
    let hidden = textureSampleLevel(table_sky, table_light_sampler, share, 0.0).x * clamp(in.normal.y, 0.0, 1.0);
    return vec4(to_target(mix(drawn, globals.shadow.rgb, globals.key.w * hidden)), 1.0);
}
