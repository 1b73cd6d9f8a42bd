"""Stored codes that meet: filtered, resolved and blended by the device."""
