"""From proved tiles to files that are cut: sheets, kerf, tabs, art and labels, and what they come to."""
