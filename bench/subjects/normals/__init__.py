"""Sets of normals: uniform ones, scenes and captured frames."""
