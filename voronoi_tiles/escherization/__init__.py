"""From an outline to designs whose exact tiles come near to it: Escherization."""
