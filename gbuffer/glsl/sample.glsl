// The sample at hand of targets that have SAMPLES of them in a pixel. More than one makes the fragment shader run for
// each.
#include "frame.glsl"

#if SAMPLES > 1
#define SAMPLER sampler2DMS
#define WORD_SAMPLER usampler2DMS
#define SAMPLE gl_SampleID
#define SAMPLE_PLACE gl_SamplePosition
#else
#define SAMPLER sampler2D
#define WORD_SAMPLER usampler2D
#define SAMPLE 0
#define SAMPLE_PLACE vec2(0.5)
#endif

// Where the sample at hand lies on the screen, from -1 to 1.
vec2 screen_place(ivec2 pixel) { return (vec2(pixel) + SAMPLE_PLACE) / size.xy * 2.0 - 1.0; }
