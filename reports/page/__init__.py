"""The HTML page of a run, and the text for a pull request."""
