"""Bodies through a capture: poses with gaps filled and noise removed, and their geometry."""
