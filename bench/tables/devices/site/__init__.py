"""The site of readers' devices: an index to search, and a page for each device."""
