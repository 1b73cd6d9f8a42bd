"""Sets of normals: uniform sets, scenes and captured frames."""
