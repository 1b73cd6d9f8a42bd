"""The data of a run for its page's laboratory: each codec's functions in GLSL ES."""
