"""The passes of the pipelines, each next to its shaders."""
