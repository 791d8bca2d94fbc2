"""Stored recordings of actions: what was done in each, and where its capture is."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from capar.model.observation import Observation
from capar.model.par import ComplexPar, Step, Upar
from capar.regeneration.efforts import EffortReport
from capar.regeneration.motion import Motion
from capar.regeneration.quality import Quality
from extractors.readers.bundle.capture_toml import place_of
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


@dataclass(frozen=True, eq=False)
class Performed:
    """A motion, and how good it is."""

    motion: Motion
    quality: Quality
    names: Mapping[str, str]
    """The scene's names of the objects by those that the motion has."""

    effort: EffortReport | None
    """With which manner it was performed; None where none was asked for."""


def observed_actions(recordings: Iterable[Recording]) -> set[str]:
    """Every action that recordings hold: steps, what these are cases of, and wholes."""
    names = set()
    for one in recordings:
        steps = {step.action for step in one.steps}
        general = (name for step in steps for name in one.general.get(step, ()))
        names |= {one.par.name, *steps, *general}
    return names


def observed_recording(observation: Observation, capture: Path) -> Recording:
    """A capture that was observed just now."""
    kinds = {each.name: (each.kind or each.name,) for each in observation.objects}
    return Recording(
        observation.capture, capture, observation.complex_par, _general(observation.upars), kinds
    )


def stored_recordings(
    actionary: Actionary, folder: Path
) -> tuple[tuple[Recording, ...], tuple[str, ...]]:
    """The observations of an Actionary whose captures are in a folder, and names of the others.

    A capture is known by the SHA-256 of its ``capture.toml``, as an Actionary does not keep where
    captures are.
    """
    files = sorted([*folder.glob(BUNDLE), *folder.glob(f"*/{BUNDLE}")], reverse=True)
    captures = {sha256(each.read_bytes()).hexdigest(): each for each in files}
    found, lost = [], []
    general = _general(actionary.upars())
    for each in sorted(actionary.observations(), key=lambda one: one.name):
        text = f"SELECT ?sum WHERE {{ GRAPH {names.observation(each.name)} {{ "
        text += f"?file a {CAPAR.SourceFile} ; {CAPAR.sha256} ?sum }} }}"
        sums = sorted(str(row["sum"]) for row in actionary.store.ask(text).plain())
        place = next((captures[one] for one in sums if one in captures), None)
        if place is None:
            lost.append(each.name)
            continue
        par = actionary.complex_par(each.name)
        kinds = {name: actionary.kinds_above(name)[:1] for name in par.objects}
        place = Path(place_of(place, each.name))
        found.append(Recording(each.name, place, par, general, kinds))
    return tuple(found), tuple(lost)


def _general(upars: tuple[Upar, ...]) -> dict[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for each in upars:
        found.setdefault(each.name, set()).update(each.general)
    return {name: frozenset(above) for name, above in found.items()}
