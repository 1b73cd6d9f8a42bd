"""OpenGL: the device, shaders and raw calls. moderngl is imported here alone."""
