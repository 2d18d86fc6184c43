"""Files: SVG, DXF, PDF, LightBurn, the outline document."""
