"""What reads captures of RenderDoc: a script for its Python, and the command that writes it."""
