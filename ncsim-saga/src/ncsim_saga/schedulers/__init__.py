"""The schedulers of this package."""
