// The sky's shade on the table: how much of it hangs full of things, seen from each place of the top.

// Height over the table of the lowest thing above each place, m.
@group(1) @binding(0) var underside: texture_2d<f32>;

// Each place looks about in so many directions, ring after ring.
const DIRECTIONS: i32 = 16;
const RINGS: i32 = 8;
// Radius of the innermost ring, m, and how much wider the next one is.
const INNERMOST: f32 = 0.0008;
const WIDER: f32 = 1.9;
// Nothing is taken to hang lower than this, m: the edge of what stands on the table is as soft.
const LOWEST: f32 = 0.0022;
// The golden section: directions begin their rings at places that never repeat, so that no ring shows.
const GOLDEN_SECTION: f32 = 0.618034;

struct SkyOut {
    @builtin(position) clip: vec4<f32>,
    // 0 to 1 along x and z of the table.
    @location(0) share: vec2<f32>,
};

@vertex
fn vs_sky(@builtin(vertex_index) vertex: u32) -> SkyOut {
    let share = vec2(f32(vertex & 1u), f32(vertex >> 1u));
    var out: SkyOut;
    out.clip = vec4(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.0, 1.0);
    out.share = share;
    return out;
}

fn height_at(share: vec2<f32>) -> f32 {
    let size = vec2<f32>(textureDimensions(underside));
    if any(share < vec2(0.0)) || any(share >= vec2(1.0)) {
        return 1e3;
    }
    // What it spans above the table is a metre.
    return from_map(textureLoad(underside, vec2<i32>(share * size), 0));
}

// Share of the sky within a distance beside the vertical at a height, as a level place sees it (the form factor of a disc).
fn within(radius: f32, height: f32) -> f32 {
    return radius * radius / (radius * radius + height * height);
}

@fragment
fn fs_sky(in: SkyOut) -> @location(0) vec4<f32> {
    var hidden = 0.0;
    for (var k = 0; k < DIRECTIONS; k++) {
        let angle = 6.2831853 * f32(k) / f32(DIRECTIONS);
        let begins = pow(WIDER, fract(GOLDEN_SECTION * f32(k)) - 1.0);
        let direction = vec2(cos(angle), sin(angle));
        var inner = 0.0;
        var outer = INNERMOST * begins;
        for (var ring = 0; ring < RINGS; ring++) {
            let place = select(sqrt(inner * outer), 0.5 * outer, ring == 0) * direction;
            let height = max(height_at(in.share + 0.5 * place / globals.table.zw), LOWEST);
            hidden += within(outer, height) - within(inner, height);
            inner = outer;
            outer *= WIDER;
        }
    }
    return vec4(hidden / f32(DIRECTIONS), 0.0, 0.0, 1.0);
}
