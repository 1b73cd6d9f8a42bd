// Wicked Engine's unit vectors of particles: x, y and z in [0, 1], cut off to 8 bits each.
min16float3 PackUnitVector(float3 v) { return v * 0.5 + 0.5; }
float3 UnpackUnitVector(float3 c) { return normalize(c * 2.0 - 1.0); }
