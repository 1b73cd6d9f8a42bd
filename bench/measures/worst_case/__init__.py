"""Suprema: the worst normal of a codec, searched for in float64."""
