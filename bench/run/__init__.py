"""Where steps are measured: in this process, a second one, or workers."""
