"""Captures to facts: readers, contact, motion and relations of bodies, without any verb."""
