"""What a page's laboratory is given of a run: each codec's code in GLSL ES."""
