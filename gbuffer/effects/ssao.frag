#version 430
// Crytek's ambient occlusion (Mittring 2007): points in a ball around the surface, flipped into the half that its normal
// points to. The share of them that the depth buffer does not hide is the visibility.
#include "taps.glsl"
#include "noise.glsl"
#include "vec.glsl"

layout(location = 0) out float visibility;

// The place of a point among others that fill a square evenly (Roberts 2018, the R2 sequence).
const vec2 SEQUENCE = vec2(0.7548776662, 0.5698402910);

// A direction: of all directions points are as dense everywhere; `turn` from 0 to 1 turns them about an axis.
vec3 direction_of(int i, float turn) {
    float z = 1.0 - (2.0 * float(i) + 1.0) / float(TAPS), angle = 2.0 * PI * (float(i) * SEQUENCE.x + turn);
    return vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(angle), sin(angle)), z);
}

// A direction of noise to mirror the others at, so that each pixel has its own.
vec3 mirror_of(vec2 noise) {
    float z = 2.0 * noise.x - 1.0, angle = 2.0 * PI * noise.y;
    return vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z);
}

// How much a point is hidden; nothing is known behind the eye. The point is moved to the ray of the pixel that is read,
// at its own depth: over a plane it then lies above the very surface that it is compared with, unless the move has taken
// it below the plane.
float hidden(vec3 point, vec3 p, vec3 n) {
    if (point.z >= 0.0) return 0.0;
    ivec2 pixel = ivec2(floor((point.xy / (-point.z * eye_ray.xy) * 0.5 + 0.5) * size.xy));
    float depth = depth_of(pixel);
    vec3 moved = at_depth(pixel, -point.z);
    bool behind = depth > 0.0 && depth < -point.z - BIAS && dot(moved - p, n) > 0.0;
    // Range check: what lies further than the radius from the surface hides less.
    return behind ? smoothstep(0.0, 1.0, RADIUS / max(abs(-p.z - depth), TINY)) : 0.0;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy), pixel = surface_pixel(texel, target_size.xy);
    Surface s = read_gbuffer(pixel);
    vec3 n = normal_of(s, pixel), noise = noise_at(texel), mirror = mirror_of(noise.xy);
    float sum = 0.0;
    for (int i = 0; i < TAPS; ++i) {
        vec3 way = reflect(direction_of(i, 0.0), mirror);
        float far = RADIUS * fract(float(i) * SEQUENCE.y + noise.z);
        sum += hidden(s.position + far * sign_not_zero(dot(way, n)) * way, s.position, n);
    }
    visibility = is_covered(pixel) ? 1.0 - sum / float(TAPS) : 1.0;
}
