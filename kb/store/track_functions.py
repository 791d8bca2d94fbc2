"""SPARQL functions that open the sampled tracks of a store: places, speeds, distances, ways.

The engine calls them with terms, and a term that fits nothing gives no value, as in SPARQL.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from jaxtyping import Float
from pyoxigraph import BlankNode, Literal, NamedNode, Triple
from pyoxigraph import Store as Oxigraph

from kb.store import names, statements
from ontology import BASE, CAPAR

Place: TypeAlias = Float[np.ndarray, "3"]
Function: TypeAlias = Callable[..., NamedNode | BlankNode | Literal | Triple | None]


@dataclass(frozen=True, eq=False)
class Track:
    """A body's sampled places, joined by straight lines."""

    step_s: float
    positions: Float[np.ndarray, "samples 3"]

    def at(self, time_s: float) -> Place:
        """The place at a time [m]; NaN where lost, or outside of the capture."""
        if self.step_s == 0.0:
            return self.positions[0]
        clock = np.arange(len(self.positions)) * self.step_s
        if not 0.0 <= time_s <= clock[-1] + 1e-6:
            return np.full(3, np.nan)
        return np.array([np.interp(time_s, clock, axis) for axis in self.positions.T])

    def speed(self, time_s: float) -> float:
        """The speed at a time [m/s], over a sample before and one after it."""
        if self.step_s == 0.0:
            return 0.0
        end = (len(self.positions) - 1) * self.step_s
        first, last = max(time_s - self.step_s, 0.0), min(time_s + self.step_s, end)
        return float(np.linalg.norm(self.at(last) - self.at(first)) / (last - first))

    def times(self, start_s: float, end_s: float) -> list[float]:
        """Two times, and those of the samples between them [s]."""
        if self.step_s == 0.0:
            return [start_s, end_s]
        inner = np.arange(np.ceil(start_s / self.step_s), np.floor(end_s / self.step_s) + 1)
        return [start_s, *(inner * self.step_s), end_s]


def track_functions(store: Oxigraph) -> dict[NamedNode, Function]:
    """The functions over the tracks of a store, by name."""
    tracks = _Tracks(store)
    called: dict[str, Function] = {
        "position": tracks.position,
        "speed": tracks.speed,
        "distance": tracks.distance,
        "highestSpeed": tracks.highest_speed,
        "pathLength": tracks.path_length,
    }
    return {NamedNode(BASE + name): function for name, function in called.items()}


class _Tracks:
    def __init__(self, store: Oxigraph) -> None:
        self._store = store
        self._known: dict[tuple[Any, Any], Track | None] = {}

    def position(self, observation: Any, body: Any, time: Any) -> Literal | None:
        track, at = self._track(observation, body), _seconds(time)
        place = None if track is None or at is None else track.at(at)
        return None if place is None or np.isnan(place).any() else statements.vector(place)

    def speed(self, observation: Any, body: Any, time: Any) -> Literal | None:
        track, at = self._track(observation, body), _seconds(time)
        return None if track is None or at is None else _number(track.speed(at))

    def distance(self, observation: Any, body: Any, other: Any, time: Any) -> Literal | None:
        one, two = self._track(observation, body), self._track(observation, other)
        at = _seconds(time)
        if one is None or two is None or at is None:
            return None
        return _number(float(np.linalg.norm(one.at(at) - two.at(at))))

    def highest_speed(self, observation: Any, body: Any, start: Any, end: Any) -> Literal | None:
        track, times = self._between(observation, body, start, end)
        if track is None or not times:
            return None
        return _number(float(np.max([track.speed(time) for time in times])))

    def path_length(self, observation: Any, body: Any, start: Any, end: Any) -> Literal | None:
        track, times = self._between(observation, body, start, end)
        if track is None or not times:
            return None
        places = np.array([track.at(each) for each in times])
        return _number(float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum()))

    def _between(
        self, observation: Any, body: Any, start: Any, end: Any
    ) -> tuple[Track | None, list[float]]:
        track, first, last = self._track(observation, body), _seconds(start), _seconds(end)
        if track is None or first is None or last is None or last < first:
            return None, []
        return track, track.times(first, last)

    def _track(self, observation: Any, body: Any) -> Track | None:
        key = (observation, body)
        if key not in self._known:
            self._known[key] = self._found(observation, body)
        return self._known[key]

    def _found(self, observation: Any, body: Any) -> Track | None:
        """The track of a body, given by its IRI or by its name in an observation."""
        if isinstance(observation, Literal):
            observation = names.observation(observation.value)
        if not isinstance(observation, NamedNode):
            return None
        nodes = [body]
        if isinstance(body, Literal):
            named = self._store.quads_for_pattern(None, CAPAR.name, body, observation)
            nodes = [each.subject for each in named]
        for node in nodes:
            for quad in self._store.quads_for_pattern(node, CAPAR.track, None, observation):
                assert isinstance(quad.object, Literal)
                sampled = statements.track_of(quad.object.value)
                return Track(sampled.step_s, sampled.positions)
        return None


def _seconds(term: Any) -> float | None:
    try:
        return float(term.value)
    except (AttributeError, ValueError):
        return None


def _number(value: float) -> Literal | None:
    return Literal(value) if np.isfinite(value) else None
