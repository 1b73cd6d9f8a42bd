"""What happens to a code when texels meet: filtering, mip levels, resolve and blending."""
