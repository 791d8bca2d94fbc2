"""Folders with recordings, the Actionary that knows them, and scenes in which to act."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import perform
from capar.body.recording import Truth, record, write_bundle
from capar.body.scripted_actions import action_capture
from capar.body.scripts import STAND
from capar.body.sensors import PERFECT
from capar.body.virtual_scenes import Thing, scene
from capar.model.capture import Capture
from capar.pipelines.observation import observe
from kb import Actionary

RATE_HZ = 30.0


@dataclass(frozen=True)
class Worlds:
    """Where recordings, the Actionary and scenes are."""

    folder: Path

    @property
    def actionary(self) -> Path:
        """The Actionary's folder."""
        return self.folder / "actionary"

    def scene(self, name: str) -> Path:
        """The bundle of a scene."""
        return self.folder / "scenes" / name

    @property
    def options(self) -> tuple[str, ...]:
        """The options by which commands find the Actionary and its recordings."""
        recordings = str(self.folder / "recordings")
        return ("--actionary", str(self.actionary), "--recordings", recordings)


def worlds_in(
    folder: Path, actions: Iterable[str], scenes: Mapping[str, Iterable[Thing]]
) -> Worlds:
    """Recordings of scripted actions with their Actionary, and scenes before which a man stands."""
    made = Worlds(folder)
    with Actionary.open(made.actionary) as words:
        for action in actions:
            place = written(action_capture(action, rate_hz=RATE_HZ), folder / "recordings" / action)
            words.add(observe(place))
    for name, things in scenes.items():
        written(standing(name, things), made.scene(name))
    return made


def written(capture: Capture, place: Path) -> Path:
    """Write a capture as a bundle."""
    place.parent.mkdir(parents=True, exist_ok=True)
    write_bundle(capture, Truth((), (), (), ()), place)
    return place


def standing(name: str, things: Iterable[Thing]) -> Capture:
    """A man who stands before things."""
    human = Human.of(ready_made("man"))
    made = perform(human, scene(*things), (STAND,), rate_hz=RATE_HZ)
    return record(made, name=name, seed=0, tracker=PERFECT)
