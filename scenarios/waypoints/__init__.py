"""A path from points of a map or a receiver: read, fitted by straights, arcs and corners, written."""
