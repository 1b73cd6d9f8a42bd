"""What NVIDIA's compiler of CUDA makes of an encoding's GLSL, without a GPU and without a graphics driver."""
