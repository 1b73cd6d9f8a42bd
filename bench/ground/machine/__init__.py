"""Properties of this machine: cores, devices, versions."""
