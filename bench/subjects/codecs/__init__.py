"""Codecs by name: from the catalogue, tuned variants of these, and users' own codecs."""
