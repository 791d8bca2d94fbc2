"""SPARQL functions that open the sampled tracks of a store: places, speeds, distances, paths.

The engine calls them with terms; a term that fits nothing gives no value, as in SPARQL.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, TypeAlias

import numpy as np
from jaxtyping import Float
from pyoxigraph import Literal, NamedNode
from pyoxigraph import Store as Oxigraph

from capar.model.locations import SampledTrack
from kb.store import names, statements
from ontology import BASE, CAPAR

Place: TypeAlias = Float[np.ndarray, "3"]


def track_functions(store: Oxigraph) -> dict[NamedNode, Callable[..., Literal | None]]:
    """The functions over the tracks of a store, by name.

    Each takes an observation, one body or two, and one time or two [s].
    """

    @cache
    def track(observation: Any, body: Any) -> SampledTrack | None:
        """The track of a body, given by its IRI or by its name in an observation."""
        if isinstance(observation, Literal):
            observation = names.observation(observation.value)
        if not isinstance(observation, NamedNode):
            return None
        nodes = [body]
        if isinstance(body, Literal):
            named = store.quads_for_pattern(None, CAPAR.name, body, observation)
            nodes = [each.subject for each in named]
        for node in nodes:
            for quad in store.quads_for_pattern(node, CAPAR.track, None, observation):
                if isinstance(quad.object, Literal):
                    return statements.track_of(quad.object.value)
        return None

    def function(bodies: int, computed: Callable[..., Any]) -> Callable[..., Literal | None]:
        def called(observation: Any, *given: Any) -> Literal | None:
            tracks = [track(observation, each) for each in given[:bodies]]
            try:
                times = [float(each.value) for each in given[bodies:]]
            except (AttributeError, ValueError):
                return None
            if any(each is None for each in tracks) or times != sorted(times):
                return None
            value = np.asarray(computed(*tracks, *times))
            if value.size == 0 or not np.isfinite(value).all():
                return None
            return statements.vector(value) if value.ndim else Literal(float(value))

        return called

    def highest_speed(track: SampledTrack, start_s: float, end_s: float) -> Any:
        return np.max([_speed(track, time) for time in _times(track, start_s, end_s)])

    def path_length(track: SampledTrack, start_s: float, end_s: float) -> Any:
        places = np.array([_at(track, each) for each in _times(track, start_s, end_s)])
        return np.linalg.norm(np.diff(places, axis=0), axis=1).sum()

    functions = {
        "position": function(1, _at),
        "speed": function(1, _speed),
        "distance": function(2, lambda a, b, time: np.linalg.norm(_at(a, time) - _at(b, time))),
        "highestSpeed": function(1, highest_speed),
        "pathLength": function(1, path_length),
    }
    return {NamedNode(BASE + name): each for name, each in functions.items()}


def _at(track: SampledTrack, time_s: float) -> Place:
    """The place at a time [m]; NaN where lost, or outside of the capture."""
    if track.step_s == 0.0:
        return np.asarray(track.positions[0])
    clock = np.arange(len(track.positions)) * track.step_s
    if not 0.0 <= time_s <= clock[-1] + 1e-6:
        return np.full(3, np.nan)
    return np.array([np.interp(time_s, clock, axis) for axis in track.positions.T])


def _speed(track: SampledTrack, time_s: float) -> float:
    """The speed at a time [m/s], over a sample before and one after it."""
    if track.step_s == 0.0:
        return 0.0
    end_s = (len(track.positions) - 1) * track.step_s
    first, last = max(time_s - track.step_s, 0.0), min(time_s + track.step_s, end_s)
    return float(np.linalg.norm(_at(track, last) - _at(track, first)) / (last - first))


def _times(track: SampledTrack, start_s: float, end_s: float) -> list[float]:
    """Two times in order, and those of the samples between them [s]."""
    if track.step_s == 0.0:
        return [start_s, end_s]
    inner = np.arange(np.ceil(start_s / track.step_s), np.floor(end_s / track.step_s) + 1)
    return [start_s, *(inner * track.step_s), end_s]
