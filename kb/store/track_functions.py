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

from capar.model.geometry import Series
from kb.store import names, statements
from ontology import BASE, CAPAR

Track: TypeAlias = tuple[Float[np.ndarray, "samples 3"], float]
"""The places of a body [m], NaN where it was lost, and the time between two of them [s]; zero where
one holds throughout."""


def track_functions(store: Oxigraph) -> dict[NamedNode, Callable[..., Literal | None]]:
    """The functions over the tracks of a store, by name.

    Each takes an observation, one body or two, and one time or two [s].
    """

    @cache
    def track(observation: Any, body: Any) -> Track | None:
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
                    known = statements.track_of(quad.object.value)
                    return known.positions, known.step_s
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

    def highest_speed(track: Track, start_s: float, end_s: float) -> Any:
        return np.max(_speeds(track, _times(track, start_s, end_s)))

    def path_length(track: Track, start_s: float, end_s: float) -> Any:
        places = _at(track, _times(track, start_s, end_s))
        return np.linalg.norm(np.diff(places, axis=0), axis=1).sum()

    functions = {
        "position": function(1, _at),
        "speed": function(1, lambda track, time: _speeds(track, np.array([time]))[0]),
        "distance": function(2, lambda a, b, time: np.linalg.norm(_at(a, time) - _at(b, time))),
        "highestSpeed": function(1, highest_speed),
        "pathLength": function(1, path_length),
    }
    return {NamedNode(BASE + name): each for name, each in functions.items()}


def _at(track: Track, times_s: float | Series) -> Float[np.ndarray, "*times 3"]:
    """The places at times [m]; NaN where lost, or outside of the capture."""
    places, step_s = track
    times = np.asarray(times_s)
    if step_s == 0.0:
        return np.broadcast_to(places[0], (*times.shape, 3))
    clock = np.arange(len(places)) * step_s
    found = np.stack([np.interp(times, clock, axis) for axis in places.T], axis=-1)
    found[~((times >= 0.0) & (times <= clock[-1] + 1e-6))] = np.nan
    return found


def _speeds(track: Track, times_s: Series) -> Series:
    """The speeds at times [m/s], each over a sample before and one after it."""
    places, step_s = track
    if step_s == 0.0:
        return np.zeros(len(times_s))
    end_s = (len(places) - 1) * step_s
    first, last = np.maximum(times_s - step_s, 0.0), np.minimum(times_s + step_s, end_s)
    ways = _at(track, last) - _at(track, first)
    return np.array([np.linalg.norm(way) for way in ways]) / (last - first)


def _times(track: Track, start_s: float, end_s: float) -> Series:
    """Two times in order, and those of the samples between them [s]."""
    _, step_s = track
    if step_s == 0.0:
        return np.array([start_s, end_s])
    inner = np.arange(np.ceil(start_s / step_s), np.floor(end_s / step_s) + 1)
    return np.array([start_s, *(inner * step_s), end_s])
