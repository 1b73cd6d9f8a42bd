"""Errors of displayed images, by the orientation of an encoding in the scene."""
