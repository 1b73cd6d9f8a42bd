"""The maps table: the error of block-compressed normal maps."""
