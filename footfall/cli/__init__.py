"""The command line: `footfall --help`."""
