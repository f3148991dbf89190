"""Footfall's own method: a filter over hypotheses (straight, curve or turn) with a physical drift."""
