"""A run's data for the laboratory on its page: each codec's functions in GLSL ES."""
