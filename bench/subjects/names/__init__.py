"""Subjects that several tables share, by name."""
