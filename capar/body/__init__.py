"""A human body of any size: its model, fitting it to sensors, and virtual performers."""

from capar.body.anthropometry import Measures as Measures
from capar.body.anthropometry import estimate_measures as estimate_measures
from capar.body.anthropometry import measures_of as measures_of
from capar.body.anthropometry import ready_made as ready_made
