"""Results of GPU compilers, which run in separate processes."""
