"""Tiles within Inkscape: its entries and their dialogs, how they are installed, and what they do with a drawing."""
