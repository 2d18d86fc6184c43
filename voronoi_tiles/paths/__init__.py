"""Lines, Bezier curves and circular arcs as arrays: where they meet, what approximates them, their offsets."""
