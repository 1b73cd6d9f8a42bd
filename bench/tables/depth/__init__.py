"""How far off positions are that were rebuilt from a stored depth."""
