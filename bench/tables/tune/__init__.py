"""Parameters fitted to normals."""
