"""The walker's laws, its physics, and what comes out: walks, truths and recordings."""
