// A quaternion alone: the hand is lost.
fn encode_quaternion(q: vec4f) -> vec4f {
    let a = abs(q);
    return vec4f(q.xyz * (select(-1.0, 1.0, q.w >= 0.0) / (a.x + a.y + a.z + a.w)), 1.0);
}

fn decode_quaternion(e: vec4f) -> vec4f {
    let q = vec4f(e.xyz, max(1.0 - abs(e.x) - abs(e.y) - abs(e.z), 0.0));
    return q * inverseSqrt(dot(q, q));
}
