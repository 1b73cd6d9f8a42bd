// A scene's pixel, for `surface_at` to read.
out uvec4 surface;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Hit hit = met(ray_at(pixel) * to_view);
    surface = hit.t > 0.0
        ? uvec4(floatBitsToUint(normalize(to_view * hit.n)), (floatBitsToUint(hit.t) & ~31u) | uint(hit.material)) : uvec4(0u);
}
