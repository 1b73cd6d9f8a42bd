"""The subjects of measurements: codecs and sets of normals, by their names and from files."""
