"""The studio: a page in the browser in which one draws, drags and sees the exact tile follow, and its local server."""
