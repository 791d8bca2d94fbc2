"""The kinematic chain that an end-effector ends, where nobody says so."""

LINKS = {"hand": "arm", "foot": "leg", "head": "neck", "eyes": "neck"}
"""The chain by the end-effectors that rules know."""


def chain_of(end_effector: str) -> str:
    """The chain that an end-effector ends; of one that rules do not know, its own name."""
    return LINKS.get(end_effector, end_effector)
