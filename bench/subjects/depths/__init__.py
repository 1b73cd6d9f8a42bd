"""Depths of users' images."""
