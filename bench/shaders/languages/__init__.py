"""Users' encoders in shading languages other than GLSL, translated once and cached."""
