// Light as it is, beside r11g11b10f.py.

vec4 r11g11b10f_encode(vec4 light) { return light; }

vec4 r11g11b10f_decode(vec4 e) { return vec4(e.xyz, 0.0); }
