"""Users' own codes of something else than normals."""
