"""What everybody stands on: errors, files, option types, this machine, compiled C."""
