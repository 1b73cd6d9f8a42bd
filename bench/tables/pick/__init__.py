"""The choice of an encoding."""
