"""The site of readers' devices: a searchable index with a section for each device."""
