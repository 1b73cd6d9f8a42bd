// Light that comes from everywhere, and what effects know of it: how much of it arrives, and what other surfaces add.
#include "frame.glsl"
#include "unlit.glsl"

#ifdef HAS_VISIBILITY
uniform sampler2D visibility;
#endif
#ifdef HAS_INDIRECT
uniform sampler2D indirect;
#endif

// What a surface at a pixel of the G-buffer shows without lights.
vec3 unlit_at(Surface s, ivec2 pixel) {
    float arriving = 1.0;
    vec3 added = vec3(0.0);
#ifdef HAS_VISIBILITY
    arriving = texelFetch(visibility, pixel, 0).x;
#endif
#ifdef HAS_INDIRECT
    added = texelFetch(indirect, pixel, 0).rgb;
#endif
    return unlit(s, arriving, added);
}
