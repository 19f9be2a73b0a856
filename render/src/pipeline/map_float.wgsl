// Maps of the light that hold a number at each place.

fn to_map(value: f32) -> vec4<f32> {
    return vec4(value, 0.0, 0.0, 0.0);
}

fn from_map(texel: vec4<f32>) -> f32 {
    return texel.x;
}
