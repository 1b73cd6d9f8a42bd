// Whether a pixel of the G-buffer holds a surface, and not what was cleared. `gbuffer.glsl` is included before.

bool is_covered(Surface s) {
    // Rounding of a stored depth may move the far plane a little: half a thousandth is more than any layout's.
    return -s.position.z >= eye_ray.z && -s.position.z < eye_ray.w * COVERED_SHARE;
}
