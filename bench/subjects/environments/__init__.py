"""Surroundings of scenes: environments by name and from files."""
