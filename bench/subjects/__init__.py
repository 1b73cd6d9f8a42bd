"""Subjects of measurements: codecs and sets of normals, by name or from files."""
