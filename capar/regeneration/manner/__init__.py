"""Manner: the Laban efforts with which something recorded is performed (spec 9)."""

from capar.regeneration.manner.adverbs import effort_of_words as effort_of_words
from capar.regeneration.manner.adverbs import told_of_words as told_of_words
from capar.regeneration.manner.efforts import Effort as Effort
from capar.regeneration.manner.efforts import read_effort as read_effort
from capar.regeneration.manner.limits import EffortReport as EffortReport
from capar.regeneration.manner.limits import regenerate_in_manner as regenerate_in_manner
from capar.regeneration.manner.limits import regenerate_with_effort as regenerate_with_effort
