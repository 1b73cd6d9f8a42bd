// X and Y, Z rebuilt as if the normal faced the camera, beside xy.py.

vec2 xy_encode(vec3 n, vec3 view) { return n.xy; }

vec3 xy_decode(vec2 e, vec3 view) {
    // n.z = sqrt(1 - e . e)
    return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0)));
}
