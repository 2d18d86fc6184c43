"""Files: what is read from drawings of others, and how drawings of ours are written."""
