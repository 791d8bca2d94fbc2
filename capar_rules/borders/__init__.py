"""From frames to numbered borders, so that rules join neighbours."""
