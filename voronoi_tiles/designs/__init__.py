"""Designs: group, cell and sites, from a file or from Python, checked before they are used."""
