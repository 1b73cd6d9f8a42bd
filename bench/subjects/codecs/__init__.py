"""Codecs by name: the catalogue's, tuned variants of these, and users' own."""
