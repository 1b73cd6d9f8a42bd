// Light as it is, beside rgba32f.py.

vec4 rgba32f_encode(vec4 light) { return light; }

vec4 rgba32f_decode(vec4 e) { return e; }
