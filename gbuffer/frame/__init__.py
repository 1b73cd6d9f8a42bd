"""Frames: their plans, their resources and the drawing tools for passes."""
