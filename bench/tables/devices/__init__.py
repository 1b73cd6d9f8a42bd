"""The codes that readers' devices produce."""
