"""What tangent frame codes lose."""
