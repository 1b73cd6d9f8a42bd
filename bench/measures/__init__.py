"""Measurement of errors: angles, images, bounds, worst cases and the meters."""
