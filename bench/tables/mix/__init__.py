"""The effect of mixing texels on stored codes: filtering, mip levels, resolving and blending."""
