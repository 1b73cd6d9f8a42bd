"""Results of GPU compilers for GLSL, computed in separate processes."""
