"""What the extension for Blender asks of the engine, in arrays: nothing here knows of Blender."""
