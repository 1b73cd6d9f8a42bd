#version 430
// The light of one triangle at a depth, where 1 is that under still water: the area that it came through by the area
// that it falls on. Added up, as triangles lie over each other where light is focused. A texel's area is what it falls on.

in vec2 above;
uniform float patch_size;
layout(location = 0) out float light;

void main() {
    vec2 x = dFdx(above), y = dFdy(above);
    float texel = patch_size / float(TEXELS);
    light = abs(x.x * y.y - x.y * y.x) / (texel * texel);
}
