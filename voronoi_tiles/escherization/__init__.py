"""Designs whose tiles come near to a given outline."""
