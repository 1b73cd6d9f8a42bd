// A unit normal to numbers in [-1, 1], and back.
vec2 mine_encode(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z < 0.0 ? (1.0 - abs(p.yx)) * sign_not_zero(p) : p;
}

vec3 mine_decode(vec2 e) {
    float z = 1.0 - abs(e.x) - abs(e.y);
    vec2 p = e - sign_not_zero(e) * max(-z, 0.0);
    return normalize(vec3(p, z));
}
