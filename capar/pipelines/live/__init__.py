"""Observation while it happens: frames in, segments out, provisional first and settled soon."""
