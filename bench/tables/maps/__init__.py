"""The maps table: what block compression loses of a normal map."""
