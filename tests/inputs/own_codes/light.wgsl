const RANGE = 6.0;

fn encode_light(light: vec3f) -> vec4f {
    let largest = max(max(light.x, light.y), light.z);
    let m = min(max(ceil(largest * (255.0 / RANGE) - 1.0 / 1024.0), 1.0), 255.0) * (1.0 / 255.0);
    return vec4f(light * (1.0 / (m * RANGE)), m);
}

fn decode_light(e: vec4f) -> vec3f {
    return e.xyz * (e.w * RANGE);
}
