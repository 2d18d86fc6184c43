"""Work in blocks on several processors: processes of our own, or Dask. It knows nothing of tiles."""
