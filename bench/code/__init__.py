"""Codecs as source code in other languages."""
