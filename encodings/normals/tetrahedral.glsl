// Tetrahedral, beside tetrahedral.py.
#include "../vec.glsl"

vec3 tetrahedral_encode(vec3 n, vec3 view) {
    const float SIDE = TETRAHEDRAL_SIDE, UP = TETRAHEDRAL_UP;
    // is_upper = SIDE |n.x| + UP n.z > SIDE |n.y| - UP n.z, side = sign of the n.x or n.y that counts
    bool is_upper = SIDE * abs(n.x) + UP * n.z > SIDE * abs(n.y) - UP * n.z;
    float deciding = is_upper ? n.x : n.y;
    float side = sign_not_zero(deciding);
    // upper: (side n.y, SIDE n.z - UP |n.x|), lower: (-side n.x, SIDE n.z + UP |n.y|)
    vec2 upper = vec2(side * n.y, SIDE * n.z - UP * abs(n.x));
    vec2 lower = vec2(-side * n.x, SIDE * n.z + UP * abs(n.y));
    float face = (is_upper ? 2.0 : 0.0) + (deciding < 0.0 ? 1.0 : 0.0);
    return vec3(is_upper ? upper : lower, number_of(face, TETRAHEDRAL_FACES));
}

vec3 tetrahedral_decode(vec3 e, vec3 view) {
    const float SIDE = TETRAHEDRAL_SIDE, UP = TETRAHEDRAL_UP;
    float face = index_of(e.z, TETRAHEDRAL_FACES);
    bool is_upper = face >= 2.0;
    float side = 1.0 - 2.0 * (face - 2.0 * floor(0.5 * face));
    vec2 p = e.xy;
    // h = sqrt(1 - p . p)
    float h = sqrt(max(1.0 - dot(p, p), 0.0));
    // upper: (side (SIDE h - UP p.y), side p.x, SIDE p.y + UP h)
    vec3 upper = vec3(side * (SIDE * h - UP * p.y), side * p.x, SIDE * p.y + UP * h);
    // lower: (-side p.x, side (SIDE h + UP p.y), SIDE p.y - UP h)
    vec3 lower = vec3(-side * p.x, side * (SIDE * h + UP * p.y), SIDE * p.y - UP * h);
    return is_upper ? upper : lower;
}
