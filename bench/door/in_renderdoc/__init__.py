"""What runs in RenderDoc's Python, and imports nothing of this package."""
