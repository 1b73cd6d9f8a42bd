"""Users' encoders in other shading languages than GLSL, translated once and kept."""
