"""Scripts that run in RenderDoc's Python and import nothing from this package."""
