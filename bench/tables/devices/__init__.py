"""What readers' devices make of the codes."""
