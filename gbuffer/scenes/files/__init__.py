"""Mesh files: glTF, OBJ, PLY, STL and OFF."""
