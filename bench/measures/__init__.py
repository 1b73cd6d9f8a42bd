"""The measurement of errors: angles, images, bounds, the worst case, and the meters."""
