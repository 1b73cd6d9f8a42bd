// Light that comes from everywhere, and what effects know of it: how much of it arrives, and what other surfaces add.
#include "frame.glsl"
#include "unlit.glsl"

#ifdef HAS_VISIBILITY
uniform sampler2D visibility;
#endif
#ifdef HAS_INDIRECT
uniform sampler2D indirect;
#endif

// The share of light from afar that arrives at a pixel of the G-buffer.
float arriving_at(ivec2 pixel) {
#ifdef HAS_VISIBILITY
    return texelFetch(visibility, pixel, 0).x;
#else
    return 1.0;
#endif
}

// What a surface there shows without lights.
vec3 unlit_at(Surface s, ivec2 pixel) {
    vec3 added = vec3(0.0);
#ifdef HAS_INDIRECT
    added = texelFetch(indirect, pixel, 0).rgb;
#endif
    return unlit(s, arriving_at(pixel), added);
}
