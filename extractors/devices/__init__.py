"""Live trackers: one driver a file, with its simulator beside it."""
