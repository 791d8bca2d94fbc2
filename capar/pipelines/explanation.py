"""The pipeline from a capture to reasons: observe it, then say why, and why not."""

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from capar.model.capture import Capture
from capar.model.observation import Observation, Segment
from capar.model.segment_address import SegmentAddress, find_segment
from capar.pipelines.observation import observe_measured
from capar_rules.engine.profiles import Profile
from capar_rules.explain.explanation import Explainer
from extractors.measure import Measurements, measure

_SEGMENT = re.compile(r"seg\((\w+),(\d+)\)")


@dataclass(frozen=True, eq=False)
class Explained:
    """A capture that was observed, and what explains its segments."""

    observation: Observation
    explainer: Explainer


def explained(capture: Capture, *, rules: Profile) -> Explained:
    """Observe a capture and make ready to explain it.

    Raises:
        CaparError: The capture or the rules have a fault.
    """
    measurements = measure(capture)
    observation = observe_measured(capture, measurements, rules=rules)
    explainer = Explainer(
        observation.facts, profile=rules, distance_m=distances(capture, measurements)
    )
    return Explained(observation, explainer)


def segments_in(seen: Explained, atom: str) -> tuple[str, ...]:
    """The segments that an atom speaks of, as a user names them: ``right_hand/3``.

    Rules name a segment by the tick where it begins, which is no index.
    """
    known = {
        (each.ee, each.first): str(SegmentAddress(each.ee, each.index))
        for each in seen.observation.segments
    }
    found = []
    for ee, tick in _SEGMENT.findall(atom):
        frames = seen.explainer.windows.frames.get(ee, [])
        name = known.get((ee, frames[int(tick)])) if int(tick) < len(frames) else None
        found += [name] if name else []
    return tuple(dict.fromkeys(found))


def distances(capture: Capture, measurements: Measurements) -> Callable[[str, int, int], float]:
    """How far an object's origin is from where it was, between two frames [m]."""

    def distance(name: str, first: int, last: int) -> float:
        track = measurements.bodies.named(name).poses.smooth.positions
        return float(np.linalg.norm(track[last] - track[first]))

    return distance


def segment_named(observation: Observation, text: str) -> Segment:
    """The segment of an observation at an address such as ``right_hand/3``.

    Raises:
        AddressError: The text is no address.
        UnknownNameError: There is no segment at it.
    """
    address = SegmentAddress.parse(text)
    return find_segment(observation.links, address, capture=observation.capture)
