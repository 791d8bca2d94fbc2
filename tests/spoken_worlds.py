"""The worlds in which something is asked for, and the recordings that can be performed."""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from bundles import DRINKING

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import perform
from capar.body.recording import record
from capar.body.scripted_actions import action_scene
from capar.body.scripts import STAND
from capar.body.sensors import PERFECT
from capar.body.virtual_scenes import Scene, Thing, box, cup, table
from capar.model.capture import Capture, TagType
from capar.pipelines.language import vocabulary
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.recordings import Recording, observed_actions
from capar.pipelines.spoken_requests import (
    Choice,
    Request,
    choices,
    read_requests,
)
from capar.pipelines.trials import trial_of
from capar.regeneration import scenes
from capar.regeneration.sources import captured_scene
from kb.language.vocabulary import Vocabulary

HERE = Path(__file__).parent
RATE_HZ = 30.0


@dataclass(frozen=True)
class Spoken:
    """What is said, where, and what should come of it."""

    say: str
    world: str
    performs: tuple[tuple[str, ...], ...]
    refused: str
    things: tuple[str, ...]
    hand: str


def spoken() -> list[Spoken]:
    """The requests that were written before they were tried."""
    rows = tomllib.loads((HERE / "regeneration" / "sentences.toml").read_text("utf-8"))["sentence"]
    return [
        Spoken(
            row["say"], row["world"],
            tuple(tuple(each) for each in row.get("performs", ())),
            row.get("refused", ""), tuple(row.get("things", ())), row.get("hand", ""),
        )
        for row in rows
    ]  # fmt: skip


@cache
def world(name: str) -> scenes.Scene:
    """The scene of a world."""
    return captured_scene(trial_of(DRINKING) if name == "demo" else _standing(name))


def _standing(name: str) -> Capture:
    """A man who stands before the things of a world."""
    human = Human.of(ready_made("man"))
    made = action_scene(human, "touch") if name == "crate" else _kitchen(human)
    return record(
        perform(human, made, (STAND,), rate_hz=RATE_HZ), name=name, seed=0, tracker=PERFECT
    )


def _kitchen(human: Human) -> Scene:
    tall = human.measures["stature"]
    top = 0.52 * tall
    board = box(0.30, 0.30, 0.03)
    things = (
        table(top, near_m=0.13 * tall),
        Thing("mug", cup(0.035, 0.09), (0.22 * tall, -0.10 * tall, top), round=True),
        Thing("crate", box(0.15, 0.20, 0.15), (0.24 * tall, 0.10 * tall, top)),
        Thing("shelf", board, (0.30, 0.62, top + 0.10), tag=TagType.FIXED, kind="shelf"),
    )
    return Scene({each.name: each for each in things})


@cache
def words() -> Vocabulary:
    """The vocabulary of the rules that ship."""
    return vocabulary(primitive_words(primitive_files()))


def understood(each: Spoken, recordings: tuple[Recording, ...]) -> tuple[Choice, ...]:
    """The recordings that are chosen for what is said."""
    asked: tuple[Request, ...] = read_requests(
        each.say, words(), world(each.world), observed_actions(recordings)
    )
    return choices(asked, recordings)
