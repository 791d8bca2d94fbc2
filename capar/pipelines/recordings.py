"""Stored recordings of actions: what was done in each, and where its capture is."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from capar.model.observation import Observation
from capar.model.par import ComplexPar, Step, Upar
from kb.actionary import Actionary
from kb.store import names
from ontology import CAPAR

BUNDLE = "capture.toml"
"""The file by which a capture is read again."""


@dataclass(frozen=True)
class Recording:
    """An observed capture that can be performed again."""

    name: str
    capture: Path
    par: ComplexPar
    general: Mapping[str, frozenset[str]]
    """The more general actions above each of its own."""

    kinds: Mapping[str, tuple[str, ...]]
    """What each of its objects is, nearest first."""

    @property
    def steps(self) -> tuple[Step, ...]:
        """Steps of every link, those of rest left out."""
        common = (self.par.common,) if self.par.common else ()
        own = (step for link in self.par.links for step in link.steps)
        return tuple(step for step in (*own, *common) if step.objects)

    def fits(self, step: Step, action: str) -> bool:
        """Whether a step is an action, or a case of it."""
        return action == step.action or action in self.general.get(step.action, ())


def observed_recording(observation: Observation, capture: Path) -> Recording:
    """A capture that was observed just now."""
    kinds = {each.name: (each.kind or each.name,) for each in observation.objects}
    return Recording(
        observation.capture, capture, observation.complex_par, _general(observation.upars), kinds
    )


def stored_recordings(actionary: Actionary) -> tuple[tuple[Recording, ...], tuple[str, ...]]:
    """The recordings of an Actionary by name, and those whose captures are not there any more."""
    found, lost = [], []
    general = _general(actionary.upars())
    for each in sorted(actionary.observations(), key=lambda one: one.name):
        place = _place(actionary, each.name)
        if place is None:
            lost.append(each.name)
            continue
        par = actionary.complex_par(each.name)
        kinds = {name: actionary.kinds_above(name)[:1] for name in par.objects}
        found.append(Recording(each.name, place, par, general, kinds))
    return tuple(found), tuple(lost)


def _general(upars: tuple[Upar, ...]) -> dict[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for each in upars:
        found.setdefault(each.name, set()).update(each.general)
    return {name: frozenset(above) for name, above in found.items()}


def _place(actionary: Actionary, observation: str) -> Path | None:
    """Where the capture of an observation was read from, if it is there still."""
    seen = names.observation(observation)
    text = f"SELECT ?file WHERE {{ ?run {CAPAR.ofObservation} {seen} ; {CAPAR.readFrom} ?file }}"
    files = sorted(str(row["file"]) for row in actionary.store.ask(text).plain())
    for each in files:
        if Path(each).name == BUNDLE and Path(each).is_file():
            return Path(each)
    return None
