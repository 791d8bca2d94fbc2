"""What can go wrong before anything moves."""

from capar.model.errors import CaparError


class PlanError(CaparError):
    """A motion that this body cannot do in this scene, or that the capture does not determine."""
