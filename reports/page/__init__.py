"""The HTML page and the text for a pull request."""
