"""Shared foundations: errors, files, option types, this machine, compiled C."""
