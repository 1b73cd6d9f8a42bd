#version 430
// An operation by itself, which cuda_writer.py writes in CUDA C++ for kernel.cu to call.
#include OPERATION
