"""Angles, images, theoretical bounds and published figures."""
