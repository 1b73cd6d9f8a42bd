"""Meshes that are made by code."""
