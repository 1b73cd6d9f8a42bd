// What the wave maps say at a place, blended by hand between texels and levels: the maps repeat, and levels do not.
// Level s leaves out the s octaves of the shortest waves.

uniform sampler3D water_heights;
uniform sampler3D water_bends;
uniform float patch_size;   // metres after which the waves repeat
uniform float shortest;     // wave, in metres
uniform float level;        // of still water

struct Wave {
    float height;
    vec2 slope;
    vec3 bend;  // second derivatives: xx, xz, zz
};

// The level whose waves are longer than POINTS_A_WAVE times the distance of two points, between 0 and LEVELS.
float level_for(float spacing) {
    return clamp(log2(max(POINTS_A_WAVE * spacing / shortest, 1.0)), 0.0, float(LEVELS));
}

// One level; `corner` is a texel, `share` where it lies between that and the next ones.
void add_level(int index, ivec2 corner, vec2 share, float weight, inout Wave wave) {
    if (index >= LEVELS || weight == 0.0) return;
    for (int i = 0; i < 4; ++i) {
        ivec2 right_up = ivec2(i & 1, i >> 1);
        vec2 part = mix(1.0 - share, share, vec2(right_up));
        ivec3 texel = ivec3((corner + right_up) & (TEXELS - 1), index);
        vec3 sum = texelFetch(water_heights, texel, 0).xyz;
        float w = weight * part.x * part.y;
        wave.height += w * sum.x;
        wave.slope += w * sum.yz;
        wave.bend += w * texelFetch(water_bends, texel, 0).xyz;
    }
}

// The waves at a place of the still water, for points that are `spacing` metres apart.
Wave wave_at(vec2 rest, float spacing) {
    float at = level_for(spacing), whole = floor(at);
    vec2 texel = rest / patch_size * float(TEXELS) - 0.5, corner = floor(texel);
    Wave wave = Wave(0.0, vec2(0.0), vec3(0.0));
    add_level(int(whole), ivec2(corner), texel - corner, 1.0 - (at - whole), wave);
    add_level(int(whole) + 1, ivec2(corner), texel - corner, at - whole, wave);
    return wave;
}

// Where a point of still water goes, in the world: up by the height, and up the slope by CHOP metres times it.
vec3 wave_point(vec2 rest, Wave wave) {
    vec2 moved = rest + CHOP * wave.slope;
    return vec3(moved.x, level + wave.height, moved.y);
}

// The normal of that surface in the world: the cross product of its derivatives along z and x.
vec3 wave_normal(Wave wave) {
    vec3 along_x = vec3(1.0 + CHOP * wave.bend.x, wave.slope.x, CHOP * wave.bend.y);
    vec3 along_z = vec3(CHOP * wave.bend.y, wave.slope.y, 1.0 + CHOP * wave.bend.z);
    return normalize(cross(along_z, along_x));
}
