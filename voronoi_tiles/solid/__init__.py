"""Solids of tiles: prisms and lofts as closed meshes, their files, pictures and reports."""
