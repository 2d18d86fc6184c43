"""DXF: a reader of anybody's files, and the writer of ours."""
