vec4 Quaternion(vec3 n, vec3 t)
{
    vec3 b = cross(n, t);
    vec4 x = vec4(1.0 + t.x - b.y - n.z, t.y + b.x, t.z + n.x, b.z - n.y);
    vec4 y = vec4(t.y + b.x, 1.0 - t.x + b.y - n.z, b.z + n.y, n.x - t.z);
    vec4 z = vec4(t.z + n.x, b.z + n.y, 1.0 - t.x - b.y + n.z, t.y - b.x);
    vec4 w = vec4(b.z - n.y, n.x - t.z, t.y - b.x, 1.0 + t.x + b.y + n.z);
    vec4 xy = x.x > y.y ? x : y, zw = z.z > w.w ? z : w;
    vec4 q = max(x.x, y.y) > max(z.z, w.w) ? xy : zw;
    return q * inversesqrt(dot(q, q));
}

// The code is in [0, 1], and the bitangent says the hand.
vec4 pack_tbn(vec3 tangent, vec3 bitangent, vec3 normal) {
    vec4 q = Quaternion(normal, tangent), a = abs(q);
    float hand = dot(cross(normal, tangent), bitangent);
    vec4 e = vec4(q.xyz * ((q.w >= 0.0 ? 1.0 : -1.0) / (a.x + a.y + a.z + a.w)), hand >= 0.0 ? 1.0 : -1.0);
    return e * 0.5 + 0.5;
}

void unpack_tbn(vec4 u, out vec3 tangent, out vec3 bitangent, out vec3 normal) {
    vec4 e = u * 2.0 - 1.0;
    vec4 q = vec4(e.xyz, max(1.0 - abs(e.x) - abs(e.y) - abs(e.z), 0.0));
    q *= inversesqrt(dot(q, q));
    tangent = vec3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.z * q.w), 2.0 * (q.x * q.z - q.y * q.w));
    normal = vec3(2.0 * (q.x * q.z + q.y * q.w), 2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    bitangent = (e.w >= 0.0 ? 1.0 : -1.0) * cross(normal, tangent);
}
