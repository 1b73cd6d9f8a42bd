"""The renderer: OpenGL device, scenes, pipelines, effects, and passes that put normals in real render targets."""
