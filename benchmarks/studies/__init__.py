"""The stock studies: what each found, as tables and a figure of its page in docs/studies."""
