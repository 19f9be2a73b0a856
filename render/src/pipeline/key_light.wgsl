// What the key light does not reach: its shadow map, and the soft shadows that are read from it.

// Depth of what is nearest to the light, 0 to 1.
@group(1) @binding(0) var nearest: texture_2d<f32>;

fn map_place(world: vec3<f32>) -> vec3<f32> {
    return (globals.map_from_world * vec4(world, 1.0)).xyz;
}

fn nearest_at(texel: vec2<i32>) -> f32 {
    let last = i32(globals.map.x) - 1;
    return from_map(textureLoad(nearest, clamp(texel, vec2(0), vec2(last)), 0));
}

fn in_map(place: vec3<f32>) -> bool {
    return all(place.xy > vec2(0.0)) && all(place.xy < vec2(1.0));
}

// Share of the key light at a place of a solid: a tent over three by three texels.
fn light_on_solid(world: vec3<f32>, normal: vec3<f32>) -> f32 {
    // Off the surface, so that it does not shade itself.
    let texel = globals.map.y;
    let place = map_place(world + texel * (1.6 * normal + 0.6 * globals.key.xyz));
    let at = place.xy * globals.map.x - 1.0;
    // What faces away is dark already; outside of the map nothing casts a shadow.
    if dot(normal, globals.key.xyz) <= 0.0 || any(at < vec2(0.0)) || any(at > vec2(globals.map.x - 3.0)) {
        return 1.0;
    }
    let first = vec2<i32>(at);
    let share = fract(at);
    var lit = vec3(0.0);
    for (var row = 0; row < 3; row++) {
        let y = first.y + row;
        let depths = vec3(
            from_map(textureLoad(nearest, vec2(first.x, y), 0)),
            from_map(textureLoad(nearest, vec2(first.x + 1, y), 0)),
            from_map(textureLoad(nearest, vec2(first.x + 2, y), 0)),
        );
        let weight = select(select(1.0, share.y, row == 2), 1.0 - share.y, row == 0);
        lit += select(vec3(0.0), vec3(weight), depths >= vec3(place.z));
    }
    return 0.25 * dot(lit, vec3(1.0 - share.x, 1.0, share.x));
}

// Cosine and sine of the golden angle: each tap is turned by it from the one before, so that they cover a disc evenly.
const GOLDEN: vec2<f32> = vec2(-0.7373688, 0.6754902);
const SEARCH: i32 = 14;
const TAPS: i32 = 18;
// What casts its shadow from farther away is too soft to matter, m.
const WIDEST: f32 = 0.010;

fn turned(v: vec2<f32>) -> vec2<f32> {
    return vec2(GOLDEN.x * v.x - GOLDEN.y * v.y, GOLDEN.y * v.x + GOLDEN.x * v.y);
}

// The same on the table, the softer the farther away the thing is that casts the shadow (Fernando 2005, percentage-closer
// soft shadows): its mean distance is looked for first.
fn light_on_table(world: vec3<f32>) -> f32 {
    let place = map_place(world + 0.0002 * globals.key.xyz);
    if !in_map(place) {
        return 1.0;
    }
    let center = place.xy * globals.map.x;
    let texels_a_metre = 1.0 / globals.map.y;
    var distance = 0.0;
    var found = 0.0;
    var toward = vec2(texels_a_metre, 0.0);
    for (var i = 0; i < SEARCH; i++) {
        // Denser in the middle: contacts are close.
        let radius = WIDEST * (f32(i) + 0.2) / f32(SEARCH);
        toward = turned(toward);
        let depth = nearest_at(vec2<i32>(center + radius * toward));
        if depth < place.z {
            distance += place.z - depth;
            found += 1.0;
        }
    }
    if found == 0.0 {
        return 1.0;
    }
    let radius = clamp(distance / found * globals.map.z * globals.map.w, 1.2 * globals.map.y, WIDEST);
    var lit = 0.0;
    for (var i = 0; i < TAPS; i++) {
        let reach = radius * sqrt((f32(i) + 0.5) / f32(TAPS));
        toward = turned(toward);
        let depth = nearest_at(vec2<i32>(center + reach * toward));
        lit += select(0.0, 1.0, depth >= place.z);
    }
    return lit / f32(TAPS);
}
