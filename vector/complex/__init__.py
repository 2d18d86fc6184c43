"""The quotient complex of a tessellation: vertices, edges and tiles, each once, up to symmetry."""
