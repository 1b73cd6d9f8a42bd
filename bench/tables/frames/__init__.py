"""The accuracy of tangent frame encodings."""
