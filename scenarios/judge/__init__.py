"""Tracks against the truth, and what the papers say."""
