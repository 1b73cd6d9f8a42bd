"""The renderer: GL device, scenes, pipelines, effects, and the passes that put normals through real render targets."""
