"""Views of what was observed: text, scripts and pictures, for people."""
