"""What lies around scenes: environments by their names and from files."""
