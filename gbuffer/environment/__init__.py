"""The distant surroundings of a scene: their images, and those images prefiltered for each roughness."""
