fn encode_velocity(v: vec2f, range: f32) -> vec2f {
    let root = sqrt(abs(v) / range);
    return select(-root, root, v >= vec2f(0.0));
}

fn decode_velocity(e: vec2f, range: f32) -> vec2f {
    return e * abs(e) * range;
}
