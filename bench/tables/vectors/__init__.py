"""Accuracy of motion vectors."""
