"""The distant surroundings of a scene: images of them, and what surfaces of each roughness see there."""
