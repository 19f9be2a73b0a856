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

// `local` is in m in the solid's own frame.
fn look_of(material: u32, local: vec3<f32>, gloss: f32) -> Look {
    // The face that is looked at is nearly always the one across z; its sides take the pattern's edge.
    let at = local.xy + vec2(0.31, 0.17) * local.z;
    let pixel = fwidth(at);
    switch material {
        case BRUSHED: {
            let cells = vec2(90.0, 2600.0);
            let streaks = noise(at * cells) - 0.5;
            let fine = noise(at * cells * vec2(1.7, 2.1) + 7.0) - 0.5;
            let shown = 0.13 * streaks * seen(pixel * cells) + 0.08 * fine * seen(pixel * cells * 2.1);
            return Look(1.0 + shown, gloss, 0.0, 0.6);
        }
        case POLISHED: {
            return Look(1.0, gloss, 0.0, 0.85);
        }
        case FOAM: {
            let cells = vec2(1900.0);
            let pores = noise(at * cells + vec2(0.0, local.z * 1500.0));
            let dark = smoothstep(0.45, 0.1, pores);
            let coarse = noise(at * 700.0 + local.z * 500.0) - 0.5;
            return Look(1.0 + 0.10 * coarse - 0.30 * dark * seen(pixel * cells), 0.4 * gloss, 0.35, 0.0);
        }
        case PAPER: {
            let cells = vec2(900.0, 1500.0);
            let fibres = noise(at * cells) + noise(at.yx * cells + 3.0) - 1.0;
            return Look(1.0 + 0.055 * fibres * seen(pixel * cells), 0.5 * gloss, 0.30, 0.0);
        }
        case WOOD: {
            // Growth rings, cut lengthwise: long bands that bend a little, with fine fibres.
            let bend = noise(at * vec2(55.0, 130.0));
            let ring = fract(at.y * 420.0 + 1.6 * bend);
            let band = smoothstep(0.0, 0.75, ring) - smoothstep(0.82, 1.0, ring);
            let cells = vec2(160.0, 3000.0);
            let fibres = noise(at * cells) - 0.5;
            let shown = seen(pixel * 420.0);
            let tint = 1.0 - 0.13 * (band - 0.5) * shown + 0.10 * fibres * seen(pixel * cells);
            return Look(tint, gloss, 0.08, 0.0);
        }
        case RUBBER: {
            return Look(1.0, 0.35 * gloss, 0.18, 0.0);
        }
        default: {
            return Look(1.0, gloss, 0.0, 0.0);
        }
    }
}
