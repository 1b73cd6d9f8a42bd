"""What can be wrong with the catalogue."""


class CatalogueError(Exception):
    """An encoding that cannot be imported or is not what the catalogue calls it; one line with its file."""
