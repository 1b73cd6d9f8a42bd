"""What GPU compilers make of GLSL, in processes of their own."""
