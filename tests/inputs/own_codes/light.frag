vec4 encode_light(vec3 light) {
    float largest = max(max(light.x, light.y), light.z);
    float m = min(max(ceil(largest * (255.0 / 6.0) - 1.0 / 1024.0), 1.0), 255.0) * (1.0 / 255.0);
    return vec4(light * (1.0 / (m * 6.0)), m);
}
void decode_light(in vec4 e, out vec3 light) { light = e.xyz * (e.w * 6.0); }
