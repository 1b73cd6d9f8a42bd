"""How exact motion vectors are."""
