"""The lowest roughness at which an encoding's reflections are acceptable."""
