"""How few bytes a pixel an image bears."""
