"""Accuracy of normals in each codec."""
