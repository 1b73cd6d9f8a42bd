"""The renderer: GL device, shaders, scenes, and the passes that put normals through real render targets."""
