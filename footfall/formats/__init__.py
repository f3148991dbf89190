"""Recordings that others made: which format a file has, what it says in SI, and whether a foot can say so."""

from footfall.formats.condition import Findings
from footfall.formats.reader import FORMATS, open_source, read
from footfall.formats.units import parse_units

__all__ = ["FORMATS", "Findings", "open_source", "parse_units", "read"]
