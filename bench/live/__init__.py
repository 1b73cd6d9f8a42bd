"""What the page's live section is given: every codec's code, and what its results must be."""
