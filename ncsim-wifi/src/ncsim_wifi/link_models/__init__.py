"""What a wireless link offers alone."""
