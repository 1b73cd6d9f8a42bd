"""What is measured: codecs and sets of normals, by their names and from files."""
