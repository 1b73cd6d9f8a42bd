"""From which roughness a normal code carries reflections."""
