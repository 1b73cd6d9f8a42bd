
// What calls a user's two functions on rows of four numbers for each normal: normal, view and a code.
@group(0) @binding(0) var<storage, read> normalbench_given: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> normalbench_made: array<vec4<f32>>;
@compute @workgroup_size(64)
fn normalbench_second(@builtin(global_invocation_id) normalbench_id: vec3<u32>) {
    let normalbench_at = normalbench_id.x;
    if normalbench_at >= arrayLength(&normalbench_made) / 2u { return; }
    let normalbench_n = normalbench_given[3u * normalbench_at];
    let normalbench_view = normalbench_given[3u * normalbench_at + 1u];
    let normalbench_code = normalbench_given[3u * normalbench_at + 2u];
    normalbench_made[2u * normalbench_at] = vec4<f32>(ENCODE(normalbench_n.xyz VIEW_E), ZEROS_E);
    normalbench_made[2u * normalbench_at + 1u] = vec4<f32>(DECODE(normalbench_code.CODE VIEW_D), 0.0);
}
