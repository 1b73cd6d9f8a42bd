"""Files of readers' devices: into a run, and as a site."""
