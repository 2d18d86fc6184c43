/* What the library of compiled kernels says about itself; setup.py compiles it, kernels.py asks. */

/* The target, and each file that the library was made from with the CRC-32 of its bytes: "name:0123abcd". */
const char *voronoi_tiles_manifest(void) { return MANIFEST; }
