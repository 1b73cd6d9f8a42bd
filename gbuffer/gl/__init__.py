"""OpenGL: the device, shaders and raw calls. Only this package imports moderngl."""
