"""The surroundings of scenes: environments by their names and from files."""
