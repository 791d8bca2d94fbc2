"""Contact of surfaces, at every frame."""
