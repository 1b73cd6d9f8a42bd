"""Codecs as they are named: the catalogue's, tuned ones, and users' own."""
