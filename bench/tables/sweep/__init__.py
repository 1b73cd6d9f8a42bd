"""Scaling of each pipeline's passes with the number of objects."""
