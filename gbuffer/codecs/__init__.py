"""Codecs in shaders: encoding into a target and decoding from the target."""
