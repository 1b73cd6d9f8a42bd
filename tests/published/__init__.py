"""Figures of articles, books and engines, measured again."""
