"""Mixing of stored codes: filtering, resolving and blending by the device."""
