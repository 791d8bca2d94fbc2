"""Bodies that move in closed form, and virtual captures of them."""
