"""What this machine has: cores, devices, versions."""
