// All three components, renormalised when read, beside xyz_renormalised.py.
#include "../vec.glsl"

vec3 xyz_renormalised_encode(vec3 n, vec3 view) { return n; }

vec3 xyz_renormalised_decode(vec3 e, vec3 view) { return unit(e); }
