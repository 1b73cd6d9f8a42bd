"""Codecs in shaders: encode into a target and decode from it."""
