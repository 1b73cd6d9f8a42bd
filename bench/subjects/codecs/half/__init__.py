"""Half arithmetic on a device with 16-bit floats: the same GLSL with 16-bit types, through Vulkan."""
