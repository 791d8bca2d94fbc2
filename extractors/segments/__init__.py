"""What is measured of a segment once it has a name: places, styles and kinds of motion."""
