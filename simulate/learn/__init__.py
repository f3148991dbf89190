"""The walker as gymnasium environments, and its training."""
