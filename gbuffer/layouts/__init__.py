"""Which bits of which targets hold what."""
