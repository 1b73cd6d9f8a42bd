"""JAX functions of one normal, compiled by this machine's C compiler for large sets of normals."""
