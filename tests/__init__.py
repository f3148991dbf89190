"""Tests, room by room as the house is; what they share is in `helpers`."""
