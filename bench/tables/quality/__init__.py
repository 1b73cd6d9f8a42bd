"""What codecs lose of normals."""
