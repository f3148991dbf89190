"""The moving body: state, laws, kernels."""
