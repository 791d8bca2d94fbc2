"""Regeneration: what was observed, performed on another body in another scene, and verified."""

from capar.regeneration.captures import capture_of as capture_of
from capar.regeneration.captures import write_motion as write_motion
from capar.regeneration.direct_mapping import map_directly as map_directly
from capar.regeneration.goals import Goal as Goal
from capar.regeneration.grips import Grip as Grip
from capar.regeneration.motion import Motion as Motion
from capar.regeneration.planning import Plan as Plan
from capar.regeneration.quality import Gate as Gate
from capar.regeneration.quality import Quality as Quality
from capar.regeneration.scenes import PlanError as PlanError
from capar.regeneration.scenes import Scene as Scene
from capar.regeneration.search import regenerate as regenerate
from capar.regeneration.sources import Source as Source
from capar.regeneration.sources import source_of as source_of
