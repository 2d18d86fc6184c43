"""Pictures of tessellations, and of where the two stages differ."""
