// Light that comes from everywhere, and what effects know of it: how much of it arrives, and what other surfaces add.
#include "frame.glsl"

#ifdef HAS_VISIBILITY
uniform sampler2D visibility;
#endif
#ifdef HAS_INDIRECT
uniform sampler2D indirect;
#endif

// Times 1 / pi, at a pixel of the G-buffer.
vec3 light_from_everywhere(ivec2 pixel) {
    vec3 light = ambient.rgb;
#ifdef HAS_VISIBILITY
    light *= texelFetch(visibility, pixel, 0).x;
#endif
#ifdef HAS_INDIRECT
    light += texelFetch(indirect, pixel, 0).rgb;
#endif
    return light;
}
