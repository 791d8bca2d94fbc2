"""How bodies stand to each other: arrangement, bearing, grips and attention."""
