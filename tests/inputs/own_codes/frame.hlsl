float4 Quaternion(float3 n, float3 t)
{
    float3 b = cross(n, t);
    float4 x = float4(1.0 + t.x - b.y - n.z, t.y + b.x, t.z + n.x, b.z - n.y);
    float4 y = float4(t.y + b.x, 1.0 - t.x + b.y - n.z, b.z + n.y, n.x - t.z);
    float4 z = float4(t.z + n.x, b.z + n.y, 1.0 - t.x - b.y + n.z, t.y - b.x);
    float4 w = float4(b.z - n.y, n.x - t.z, t.y - b.x, 1.0 + t.x + b.y + n.z);
    float4 xy = x.x > y.y ? x : y, zw = z.z > w.w ? z : w;
    float4 q = max(x.x, y.y) > max(z.z, w.w) ? xy : zw;
    return q * rsqrt(dot(q, q));
}

float4 PackFrame(float3 normal, float3 tangent, float handedness)
{
    float4 q = Quaternion(normal, tangent), a = abs(q);
    return float4(q.xyz * ((q.w >= 0.0 ? 1.0 : -1.0) / (a.x + a.y + a.z + a.w)), handedness);
}

void UnpackFrame(float4 e, out float3 n, out float4 t)
{
    float4 q = float4(e.xyz, max(1.0 - abs(e.x) - abs(e.y) - abs(e.z), 0.0));
    q *= rsqrt(dot(q, q));
    float3 tangent = float3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.z * q.w), 2.0 * (q.x * q.z - q.y * q.w));
    n = float3(2.0 * (q.x * q.z + q.y * q.w), 2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    t = float4(tangent, e.w >= 0.0 ? 1.0 : -1.0);
}
