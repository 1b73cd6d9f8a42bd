"""The tables, a folder each."""
