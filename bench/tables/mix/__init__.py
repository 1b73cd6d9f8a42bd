"""The effect on codes of mixing texels: filtering, mip levels, resolve and blending."""
