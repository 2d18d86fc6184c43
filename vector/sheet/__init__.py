"""Tiles on a sheet: one period, the tiles that a region holds, their lines each once, closed pieces, the order."""
