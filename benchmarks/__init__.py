"""Measurements that print the figures of docs/: from the checkout,
`python -m benchmarks.ROOM.NAME --help`."""
