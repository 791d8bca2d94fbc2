"""A human body of any size: its model, fitting it to sensors, and virtual performers."""

from capar.body.measures import Measures as Measures
from capar.body.measures import estimate_measures as estimate_measures
from capar.body.measures import measures_of as measures_of
from capar.body.measures import ready_made as ready_made
