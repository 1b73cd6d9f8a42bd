"""What readers' devices are and do."""
