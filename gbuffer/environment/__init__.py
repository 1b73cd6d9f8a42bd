"""The distant surroundings of a scene: images, and levels prefiltered for each roughness."""
