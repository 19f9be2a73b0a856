// What things are made of. The numbers are those of `Material`.

const PLAIN: u32 = 0u;
const BRUSHED: u32 = 1u;
const POLISHED: u32 = 2u;
const FOAM: u32 = 3u;
const PAPER: u32 = 4u;
const WOOD: u32 = 5u;
const RUBBER: u32 = 6u;

struct Look {
    // Factor of the colour.
    tint: f32,
    gloss: f32,
    // How far light reaches around the edge of its shade: soft things.
    wrap: f32,
    // 1: it mirrors its surroundings.
    metal: f32,
};

fn hash(cell: vec2<f32>) -> f32 {
    let p = fract(cell * vec2(0.1031, 0.1131));
    let q = p + dot(p, p.yx + 33.33);
    return fract((q.x + q.y) * q.x * 17.0);
}

// Smooth noise from 0 to 1, one bump a cell.
fn noise(at: vec2<f32>) -> f32 {
    let cell = floor(at);
    let f = at - cell;
    let s = f * f * (3.0 - 2.0 * f);
    let low = mix(hash(cell), hash(cell + vec2(1.0, 0.0)), s.x);
    let high = mix(hash(cell + vec2(0.0, 1.0)), hash(cell + vec2(1.0, 1.0)), s.x);
    return mix(low, high, s.y);
}

// How much of a pattern can be seen that repeats every cell: what is finer than pixels is left away.
fn seen(cells_a_pixel: vec2<f32>) -> f32 {
    return clamp(1.6 - 2.2 * max(cells_a_pixel.x, cells_a_pixel.y), 0.0, 1.0);
}

// How two layers of noise make a material. A software driver computes every branch for every pixel: so the branches only choose
// numbers, and the noise is computed once.
struct Recipe {
    // Bumps a metre along x and y of the two layers.
    first: vec2<f32>,
    second: vec2<f32>,
    // How much the layers change the colour.
    strengths: vec2<f32>,
    // Darkness of pores where the first layer is low; darkness of growth rings that the first layer bends.
    pores: f32,
    rings: f32,
    // Share of the gloss; reach of light around edges; share of mirroring.
    finish: vec3<f32>,
};

fn recipe_of(material: u32) -> Recipe {
    var r = Recipe(vec2(1.0), vec2(1.0), vec2(0.0), 0.0, 0.0, vec3(1.0, 0.0, 0.0));
    switch material {
        case BRUSHED: {
            r = Recipe(vec2(90.0, 2600.0), vec2(153.0, 5460.0), vec2(0.13, 0.08), 0.0, 0.0, vec3(1.0, 0.0, 0.6));
        }
        case POLISHED: {
            r.finish = vec3(1.0, 0.0, 0.85);
        }
        case FOAM: {
            r = Recipe(vec2(1900.0), vec2(700.0), vec2(0.0, 0.10), 0.30, 0.0, vec3(0.4, 0.35, 0.0));
        }
        case PAPER: {
            r = Recipe(vec2(900.0, 1500.0), vec2(1500.0, 900.0), vec2(0.055), 0.0, 0.0, vec3(0.5, 0.30, 0.0));
        }
        case WOOD: {
            // Cut lengthwise: long bands that bend a little, with fine fibres.
            r = Recipe(vec2(55.0, 130.0), vec2(160.0, 3000.0), vec2(0.0, 0.10), 0.0, 0.13, vec3(1.0, 0.08, 0.0));
        }
        case RUBBER: {
            r.finish = vec3(0.35, 0.18, 0.0);
        }
        default: {}
    }
    return r;
}

// Growth rings a metre, and how far they bend, in rings.
const RINGS: f32 = 420.0;
const BEND: f32 = 1.6;

// `local` is in m in the solid's own frame.
fn look_of(material: u32, local: vec3<f32>, gloss: f32) -> Look {
    // The face that is looked at is nearly always the one across z; its sides take the pattern's edge.
    let at = local.xy + vec2(0.31, 0.17) * local.z;
    let pixel = fwidth(at);
    let r = recipe_of(material);
    let first = noise(at * r.first);
    let second = noise(at * r.second + 7.0);
    let shown = vec2(seen(pixel * r.first), seen(pixel * r.second));
    let ring = fract(at.y * RINGS + BEND * first);
    let band = smoothstep(0.0, 0.75, ring) - smoothstep(0.82, 1.0, ring);
    let pore = smoothstep(0.45, 0.1, first);
    var tint = 1.0 + dot(r.strengths * shown, vec2(first, second) - 0.5);
    tint -= r.pores * pore * shown.x + r.rings * (band - 0.5) * seen(pixel * RINGS);
    return Look(tint, gloss * r.finish.x, r.finish.y, r.finish.z);
}
