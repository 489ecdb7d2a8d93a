"""Sessions of interference models, and who works with which."""
