// Spheremap in RG8, by hand: what tests of the runners run.
fn spheremap_rg8_encode(n: vec3<f32>) -> vec2<f32> {
    let f = sqrt(8.0 * n.z + 8.0);
    if (n.z > -1.0) { return n.xy * (2.0 / f); }
    return vec2<f32>(1.0, 0.0);
}
fn spheremap_rg8_pack(code: vec2<f32>) -> u32 {
    let bytes = vec2<u32>(round(clamp(code * 0.5 + 0.5, vec2<f32>(0.0), vec2<f32>(1.0)) * 255.0));
    return bytes.x | (bytes.y << 8u);
}
fn spheremap_rg8_unpack(words: u32) -> vec2<f32> {
    return vec2<f32>(f32(words & 255u), f32((words >> 8u) & 255u)) * (1.0 / 255.0) * 2.0 - 1.0;
}
fn spheremap_rg8_decode(e: vec2<f32>) -> vec3<f32> {
    let fenc = e * 2.0;
    let f = min(dot(fenc, fenc), 4.0);
    return vec3<f32>(fenc * sqrt(1.0 - f / 4.0), 1.0 - f / 2.0);
}
fn spheremap_rg8_to_target(code: vec2<f32>) -> vec4<f32> { return vec4<f32>(code * 0.5 + 0.5, 0.0, 1.0); }
fn spheremap_rg8_from_target(texel: vec4<f32>) -> vec2<f32> { return texel.xy * 2.0 - 1.0; }
