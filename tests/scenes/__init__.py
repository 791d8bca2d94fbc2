"""Batteries of scenes in closed form, written without sight of what observes them."""
