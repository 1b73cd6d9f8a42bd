"""The passes of the pipelines, each beside its shaders."""
