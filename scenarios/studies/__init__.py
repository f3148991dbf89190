"""Studies: many trials, and what is asked of them."""
