"""Half arithmetic on a device that computes so: the same GLSL in 16-bit types, through Vulkan."""
