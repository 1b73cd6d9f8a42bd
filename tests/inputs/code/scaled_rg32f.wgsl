// By hand, for tests of the runners: a code with a view, a table, a sign and two words. Every step is exact.
@group(0) @binding(0) var scaled_steps: texture_2d<f32>;

fn scaled_rg32f_step(z: f32) -> f32 { return textureLoad(scaled_steps, vec2<i32>(select(0, 1, z < 0.0), 0), 0).y; }

fn scaled_rg32f_encode(n: vec3<f32>, view: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(n.xy * scaled_rg32f_step(n.z) + view.xy, select(1.0, -1.0, n.z < 0.0));
}
fn scaled_rg32f_pack(code: vec3<f32>) -> vec2<u32> { return bitcast<vec2<u32>>(code.xy); }
fn scaled_rg32f_unpack(words: vec2<u32>, sign: f32) -> vec3<f32> { return vec3<f32>(bitcast<vec2<f32>>(words), sign); }
fn scaled_rg32f_decode(e: vec3<f32>, view: vec3<f32>) -> vec3<f32> {
    return vec3<f32>((e.xy - view.xy) / scaled_rg32f_step(e.z), e.z);
}
fn scaled_rg32f_to_target(code: vec3<f32>) -> vec4<f32> { return vec4<f32>(code.xy, 0.0, 1.0); }
fn scaled_rg32f_from_target(texel: vec4<f32>, sign: f32) -> vec3<f32> { return vec3<f32>(texel.xy, sign); }
