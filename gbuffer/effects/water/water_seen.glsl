// What is seen in water and through it. A ray is followed over the depth that lies in its way while the water is still,
// and what it meets there is looked up where it lies on the screen. Only the difference that waves make moves a look-up:
// still water moves none. position, world: the point of the surface, view space and world.

uniform SAMPLER final;
uniform SAMPLER water_behind;
uniform sampler2D water_mirror;
uniform sampler2D water_mirror_depth;
uniform sampler3D water_caustics;
uniform mat4 mirror_to_view;
uniform vec3 extinction;
uniform vec3 sun_drift;  // the way of refracted sunlight in the world, for each metre of depth

in vec3 position;
in vec3 world;

// Where a point lies in the image, in pixels from its centre.
vec2 on_screen(vec3 p) {
    vec4 clip = projection * vec4(p, 1.0);
    return clip.xy / max(clip.w, eye_ray.z) * 0.5 * target_size.xy;
}

// What a facet of normal n mirrors, followed as if mirrored at the still surface: downwards, or level at most.
vec3 mirror_way(vec3 n, vec3 up) {
    vec3 way = reflect(reflect(unit(position), n), up);
    return way - up * max(dot(way, up), 0.0);
}

// The mirror image shows left and right exchanged: a camera cannot be mirrored, only turned over.
vec3 mirrored(vec3 n, vec3 up, float lost) {
    ivec2 pixel = ivec2(gl_FragCoord.xy), turned = ivec2(int(target_size.x) - 1 - pixel.x, pixel.y);
    vec2 place = (vec2(turned) + 0.5) / target_size.xy * 2.0 - 1.0;
    float depth = texelFetch(water_mirror_depth, turned, 0).x;
    float z = -position_from_window_depth(place, depth, vec2(2.0, -1.0), mirror_to_view).z;
    float metres = length(position) * max((depth < 1.0 ? min(z, eye_ray.w) : eye_ray.w) / -position.z - 1.0, 0.0);
    vec2 straight = on_screen(position + metres * mirror_way(unit(up), up));
    // A crest is as far below the still surface, in the mirror, as it is above it.
    vec3 from = position - 2.0 * (world.y - level) * up;
    // Waves too short to be seen tilt facets to and from the eye, which draws the image out in height.
    vec3 ahead = unit(position - up * dot(position, up)), sum = vec3(0.0);
    float tilt = BLUR * sqrt(0.5 * lost), total = 0.0;
    for (int i = -BLUR_TAPS; i <= BLUR_TAPS; ++i) {
        float deviations = 2.0 * float(i) / float(BLUR_TAPS), weight = exp(-0.5 * deviations * deviations);
        vec2 moved = on_screen(from + metres * mirror_way(unit(n + deviations * tilt * ahead), up)) - straight;
        vec2 uv = (vec2(pixel) + 0.5 + moved) / target_size.xy;
        sum += weight * texture(water_mirror, vec2(1.0 - uv.x, uv.y)).rgb;
        total += weight;
    }
    return sum / total;
}

vec3 behind_at(ivec2 pixel) {
    vec2 place = (vec2(pixel) + SAMPLE_PLACE) / target_size.xy * 2.0 - 1.0;
    return position_from_linear_depth(place, texelFetch(water_behind, pixel, SAMPLE).x, eye_ray.xy);
}

float height_of(vec3 p) { return (view_to_world * vec4(p, 1.0)).y; }

// The sun's light on the ground under the water, by that under still water.
float caustic(vec3 p) {
    vec3 ground = (view_to_world * vec4(p, 1.0)).xyz;
    float depth = max(level - ground.y, 0.0), at = min(depth / CAUSTIC_STEP, float(CAUSTIC_SLICES - 1)), light = 0.0;
    vec2 texel = (ground.xz - sun_drift.xz * depth) / patch_size * float(TEXELS) - 0.5, corner = floor(texel);
    vec2 share = texel - corner;
    int slice = int(at), next = min(slice + 1, CAUSTIC_SLICES - 1);
    for (int i = 0; i < 4; ++i) {
        ivec2 right_up = ivec2(i & 1, i >> 1), from = (ivec2(corner) + right_up) & (TEXELS - 1);
        vec2 part = mix(1.0 - share, share, vec2(right_up));
        float near = texelFetch(water_caustics, ivec3(from, slice), 0).x;
        float far = texelFetch(water_caustics, ivec3(from, next), 0).x;
        light += part.x * part.y * mix(near, far, at - float(slice));
    }
    return light;
}

// The image of a pixel, lit through waves; `sun_share` is that of the sun in the light on level ground.
vec3 ground_at(ivec2 pixel, vec3 p, vec3 sun_share) {
    vec3 colour = texelFetch(final, pixel, SAMPLE).rgb;
#if LIT_BY_SUN
    colour *= 1.0 + CAUSTICS * sun_share * sunlight(p) * (caustic(p) - 1.0);
#endif
    return colour;
}

struct Seen {
    vec3 colour;    // of what counts, times its weight, as much as gets through the water
    vec3 left;      // share of light that gets through, times the weight
    float valid;    // weight of what lies below the water
};

// Four neighbouring pixels, those above the water left out if GUARDED.
Seen seen_at(vec2 place, vec3 sun_share) {
    vec2 corner = floor(place), share = place - corner;
    Seen seen = Seen(vec3(0.0), vec3(0.0), 0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 right_up = ivec2(i & 1, i >> 1), pixel = ivec2(corner) + right_up;
        vec2 part = mix(1.0 - share, share, vec2(right_up));
        pixel = clamp(pixel, ivec2(0), ivec2(target_size.xy) - 1);
        vec3 p = behind_at(pixel);
        if (part.x * part.y == 0.0 || (GUARDED != 0 && height_of(p) >= world.y)) continue;
        vec3 left = part.x * part.y * transmittance(extinction, distance(p, position));
        seen.colour += left * ground_at(pixel, p, sun_share);
        seen.left += left;
        seen.valid += part.x * part.y;
    }
    return seen;
}

// What is seen through a facet of normal n. `deep` is what water looks like where nothing is.
vec3 refracted(vec3 n, vec3 up, vec3 deep, vec3 sun_share) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 way = unit(position);
    float metres = distance(behind_at(pixel), position);
    vec3 bent = refract(way, n, 1.0 / INDEX), straight = refract(way, up, 1.0 / INDEX);
    vec2 moved = on_screen(position + metres * bent) - on_screen(position + metres * straight);
    Seen seen = seen_at(vec2(pixel) + moved, sun_share);
#if BY_ALPHA
    // alpha = lerp(1 - T, 1, below the water), out = ((1 - T) deep + T seen) / alpha: what lies above the water has no
    // weight. Where the water is so thin that nothing would be left, the pixel's own ground counts.
    vec3 fog = 1.0 - transmittance(extinction, metres), alpha = mix(fog, vec3(1.0), seen.valid);
    if (min(alpha.x, min(alpha.y, alpha.z)) > LEAST_WEIGHT)
        return (seen.colour + (seen.valid - seen.left + (1.0 - seen.valid) * fog) * deep) / alpha;
#else
    // Where one of the four lies above the water the look-up stays where it is.
    if (seen.valid > 1.0 - LEAST_WEIGHT) return seen.colour + (1.0 - seen.left) * deep;
#endif
    vec3 left = transmittance(extinction, metres);
    return left * ground_at(pixel, behind_at(pixel), sun_share) + (1.0 - left) * deep;
}
