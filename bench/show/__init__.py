"""Output for people: the terminal, the page and the site."""
