"""Memory traffic against arithmetic: which encoding is faster on which GPU."""
