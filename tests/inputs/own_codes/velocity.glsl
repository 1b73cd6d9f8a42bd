#version 430
uniform sampler2D scene;
vec2 signs(vec2 v) { return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }
vec2 encodeMotion(vec2 v, float range) { return signs(v) * sqrt(abs(v) / range); }
vec2 decodeMotion(vec2 e, float range) { return e * abs(e) * range; }
void main() {}
