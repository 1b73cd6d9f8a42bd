"""How errors are measured: angles, images, bounds, the worst case, and the meters."""
