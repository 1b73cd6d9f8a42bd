"""The pytest plugin: a fixture, a marker and files of gates."""
