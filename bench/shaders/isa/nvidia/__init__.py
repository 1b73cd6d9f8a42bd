"""Results of NVIDIA's CUDA compiler for an encoding's GLSL, which need neither a GPU nor a graphics driver."""
