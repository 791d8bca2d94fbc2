"""Forces told by their effects: restitution, damping and impulse of things that move on alone."""
