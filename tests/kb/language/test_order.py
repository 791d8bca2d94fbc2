"""Connectives agree with the times of what they join, whatever two hands did."""

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
from observations import MUG, Piece, observation
from tellings import against_time, spans, steps_of, verbs_of

from capar.model.observation import Observation
from capar.model.par import FeatureSet
from kb.language.describe import describe

THINGS = ("mug", "bowl", "bottle")
OWN = FeatureSet("1", "1", "1", "hand", "0")
HANDLED = ("Raise", "Lower", "Shake", "Turn", "Tilt")


@st.composite
def hands(draw: st.DrawFn) -> dict[str, tuple[Piece, ...]]:
    """What two hands did: each took things, handled them and let go, with rests between."""
    out: dict[str, tuple[Piece, ...]] = {}
    for ee in ("right_hand", "left_hand"):
        pieces: list[Piece] = []
        frame = 0
        for _ in range(draw(st.integers(1, 3))):
            thing = draw(st.sampled_from(THINGS))
            done = draw(st.lists(st.sampled_from((*HANDLED, "Touch")), max_size=4))
            for name in ("Rest", "Reach", *done, "ResumePosture"):
                frame += draw(st.integers(10, 300))
                objects = () if name == "Rest" else (thing,)
                features = OWN if name in HANDLED else None
                pieces.append(Piece(name, frame, objects, features=features))
        out[ee] = tuple(pieces)
    return out


def seen(links: dict[str, tuple[Piece, ...]]) -> Observation:
    """The observation of those hands, at 100 Hz."""
    frames = max(pieces[-1].last for pieces in links.values()) + 1
    things = tuple(replace(MUG, name=name, kind=name) for name in THINGS)
    made = observation("Drawn", links, things, frames=frames, rate_hz=100.0)
    own = tuple(
        replace(
            link,
            segments=tuple(
                replace(each, possessed=each.name in HANDLED or each.name == "Touch")
                for each in link.segments
            ),
        )
        for link in made.links
    )
    return replace(made, links=own)


@given(hands())
def test_no_connective_contradicts_the_times(links: dict[str, tuple[Piece, ...]]) -> None:
    for detail in ("steps", "summary"):
        told = describe(seen(links), detail=detail, timed=True)
        assert spans(told)
        assert against_time(told) == []


@given(hands())
def test_every_verb_of_a_telling_is_read_back(links: dict[str, tuple[Piece, ...]]) -> None:
    for timed in (False, True):
        told = describe(seen(links), timed=timed)
        assert len(steps_of(told)) == len(verbs_of(told))
