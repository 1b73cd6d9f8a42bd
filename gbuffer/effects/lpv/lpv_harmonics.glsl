// Two bands of spherical harmonics, in the order Y_00, Y_1-1, Y_10, Y_11. Constants come from lpv_harmonics.py.

vec4 harmonics(vec3 w) { return vec4(SH0, -SH1 * w.y, SH1 * w.z, -SH1 * w.x); }

// max(n.w, 0)
vec4 cosine_lobe(vec3 n) { return vec4(LOBE0, -LOBE1 * n.y, LOBE1 * n.z, -LOBE1 * n.x); }
