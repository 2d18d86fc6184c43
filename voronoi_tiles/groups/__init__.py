"""The 17 wallpaper groups: their operations, their symmetry elements, and colourings that repeat with them."""
