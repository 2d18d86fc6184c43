"""Run the command line as `python -m voronoi_tiles`."""

from voronoi_tiles.cli.main import run

if __name__ == "__main__":
    run()
