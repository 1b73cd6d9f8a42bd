// A pixel of a reader's model, for `surface_at` to read: seen from behind, a triangle is the other side of a sheet.
in vec3 n;
in vec3 view;

out uvec4 surface;

void main() {
    vec3 towards = normalize(gl_FrontFacing ? n : -n);
    surface = uvec4(floatBitsToUint(towards), (floatBitsToUint(length(view)) & ~31u) | 1u);
}
