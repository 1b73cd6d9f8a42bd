"""Users' own encodings of quantities other than normals."""
