"""Sampled motion: gaps, noise, filters, zero crossings and turning points."""
