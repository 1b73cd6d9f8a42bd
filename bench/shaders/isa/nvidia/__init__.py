"""Results of NVIDIA's CUDA compiler for an encoding's GLSL, without a GPU and without a graphics driver."""
