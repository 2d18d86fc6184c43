"""G-code for lasers whose controllers run GRBL: a writer of ours, and a strict reader of lines and arcs."""
