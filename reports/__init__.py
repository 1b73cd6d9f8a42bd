"""Tables and pictures. This package takes data frames and images and depends on no other top-level package."""
