"""Commands of the command line that have a module of their own; voronoi_tiles.cli.main registers them."""
