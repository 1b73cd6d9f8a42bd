"""The places where steps are measured: this process, a second process, or workers."""
