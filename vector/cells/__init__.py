"""The cells of the elements of a site, and the boundary that they make."""
