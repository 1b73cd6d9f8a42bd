float2 Sign(float2 v) { return float2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

float2 EncodeVelocity(float2 v, float range) { return Sign(v) * sqrt(abs(v) / range); }
float2 DecodeVelocity(float2 e, float range) { return e * abs(e) * range; }
