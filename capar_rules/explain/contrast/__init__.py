"""Neighbouring names: which come near a segment, and what decided against them."""
