// Maps of the light that hold a number from 0 to 1 in three bytes, each the part that the one before is too coarse for.

const PARTS: vec3<f32> = vec3(1.0, 255.0, 65025.0);

fn to_map(value: f32) -> vec4<f32> {
    let parts = fract(PARTS * clamp(value, 0.0, 0.999999));
    return vec4(parts.xy - parts.yz / 255.0, parts.z, 1.0);
}

// Where nothing was drawn all bytes are full: farther away than anything.
fn from_map(texel: vec4<f32>) -> f32 {
    return select(dot(texel.xyz, 1.0 / PARTS), 1e3, all(texel.xyz == vec3(1.0)));
}
