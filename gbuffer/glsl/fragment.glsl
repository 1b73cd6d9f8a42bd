// The surface under a fragment of geometry: its material, its normal map.
#include "frame.glsl"
#include "instance.glsl"
#include "material.glsl"

in vec3 position;
in vec3 normal;
in vec4 tangent;
in vec2 uv;
flat in int index;

uniform sampler2D bumps;  // slopes along u and v

Surface shaded_surface() {
    ivec4 drawn = instances[index].material_layer;
    Material m = materials[drawn.x];
    vec3 n = unit(normal), t = unit(tangent.xyz - n * dot(n, tangent.xyz)), b = tangent.w * cross(n, t);
    vec2 slope = texture(bumps, uv).xy * m.bump.x;
    int kind = int(m.emissive_kind.w);
    // A strand of hair runs along v. It has no sign: the half of it that faces the eye is in every encoding's domain.
    vec3 strand = b.z < 0.0 ? -b : b;
    vec3 direction = kind == HAIR ? strand : unit(n - slope.x * t - slope.y * b);
    vec4 then = previous_clip * vec4(position, 1.0), now = projection * vec4(position, 1.0);
    vec2 motion = (now.xy / now.w - then.xy / then.w) * 0.5;
    return Surface(position, direction, m.albedo_alpha.rgb, m.specular_power.rgb, m.emissive_kind.rgb,
                   m.specular_power.w, m.albedo_alpha.a, kind, drawn.z, drawn.y, motion);
}
