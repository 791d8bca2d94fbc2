"""Each sentence of an explanation is true: recomputed from the capture, not from its rules."""

import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

import motions
import pytest
from recomputed import STORIES, Known, form, told

from capar.model.facts import Fact, FlickerCorrection, Frames, Touching, ZeroCrossing
from capar.pipelines.explanation import explained
from capar_rules.engine.profiles import profile
from capar_rules.explain.explanation import Explainer, Reason, rule_base
from capar_rules.explain.sentences import Key, Template
from capar_rules.pars.inference import infer
from extractors.measure import measure

pytestmark = pytest.mark.long

TOLD_OF_NO_NAME: dict[Key, str] = {
    ("", "against", 4, ""): "only prepositions rest on it, and no name on a preposition",
    ("", "support", 2, ""): "it keeps an object off the list: what is told is that it is none",
    ("", "bears", 4, "part"): "names rest on a foot's bearing all or nothing",
    ("", "event", 6, "levels"): "no story has a transit of three phases; the scenes have",
    ("", "rides", 3, ""): "no story has a load; the scenes and tests/extractors/test_loads.py have",
    ("", "borne_along", 3, ""): "no story has a load",
    ("", "presses", 5, ""): "no story has two palms beside each other on one side; the scenes have",
    ("", "jostled", 2, ""): "no story has a thing that is gripped and shoved; slide.cases has",
    ("", "event", 6, "begins_swinging"): "no story swings a thing amid its motion; the scenes do",
    ("", "event", 6, "ends_swinging"): "no story swings a thing amid its motion; the scenes do",
    ("", "event", 6, "tips"): "no story leans a thing over amid its motion; the scenes do",
    ("", "event", 6, "rights"): "no story leans a thing over amid its motion; the scenes do",
    ("", "met_unseen", 2, ""): "in no story a hand is lost; recordings have it",
    ("", "closing", 4, "0"): "in no story a hand is lost; recordings have it",
    ("", "strikes_with", 2, ""): "no story has a tool; tests/kb/language/test_instruments.py has",
    ("", "pushes_with", 2, ""): "no story has a tool",
    ("", "sends_off", 2, ""): "no story strikes away what a hand does not hold; the scenes do",
    ("", "wrung", 2, ""): "no story has a thing turned about in the hand; shake.cases has",
    ("", "awaited", 1, ""): "no story has hands that meet; the scenes of hands have",
    ("", "uncounted", 4, ""): "no story has a contact that ends within the border it is read at",
    ("", "event", 6, "turns"): "no named segment of a story begins or ends where the hand turns",
    ("", "parted_from", 3, ""): "no story takes a thing off a support and puts it there again",
    ("", "walks", 1, ""): "no story has feet; tests/test_whole_bodies.py has",
}
"""Templates of what holds that no explanation tells, and why."""

OF_AUTHORS = (
    ("contact_ms", 4), ("rest_ms", 2), ("recurs", 4), ("touched_times", 3),
    ("next_segment", 2), ("next_step", 2), ("soon_after", 2), ("by_other_hand", 2),
    ("swing_count", 2), ("met_mm_s", 4), ("left_mm_s", 3), ("mean_mm_s", 3), ("borne_at", 4),
    ("contains_at", 4), ("hangs_at", 4), ("touches_with", 4), ("heads_for", 3),
    ("toward_performer", 2), ("from_performer", 2), ("of_performer", 2),
)  # fmt: skip
"""Words of ``circumstances/`` and of instruments that no shipped name asks for."""

TOLD_OF_NO_NAME |= {
    ("", "accompanied", 1, ""): "no story has several things in one hand; the scenes have",
    ("", "core_features", 5, ""): "no story has several things in one hand",
}
TOLD_OF_NO_NAME |= {
    ("", *each, ""): "no shipped name rests on it; test_circumstances.py tells it"
    for each in OF_AUTHORS
}

TRUE_OF_ANY_SEGMENT = {
    r"force passes to objects in this trial, as its user says": "it is said of the whole capture",
    r"the ([\w ]+?) belongs to ([\w ]+?)": "it is said of the whole capture",
    r"the ([\w ]+?) and the ([\w ]+?) are of different agents": "it is said of the whole capture",
    r"the ([\w ]+?) counts as the foot": "it is said of the whole capture",
    r"the ([\w ]+?) is a (movable) thing": "it is said of the whole capture",
    r"the ([\w ]+?) is (fixed|part of a body)": "it is said of the whole capture",
    r"the ([\w ]+?) went along one rail in the ([\w ]+?) throughout the recording": (
        "it is said of the whole capture"
    ),
    r"the ([\w ]+?) turned about one hinge on the ([\w ]+?) throughout the recording": (
        "it is said of the whole capture"
    ),
    r"the ([\w ]+?) did not carry the ([\w ]+?) along": "no story has a load",
    r"the ([\w ]+?) stayed with the ([\w ]+?)": "it is said of a whole contact",
    (
        r"the ([\w ]+?) touched no recorded or assumed object when the segment began, nor when it "
        r"ended"
    ): (
        "who moves and touches nothing in a story never does; test_circumstances.py finds it false"
    ),
}
"""Forms that have neither a time nor a segment by which they could be false."""


def reasons(name: str) -> Iterator[tuple[Known, Reason]]:
    """Every reason that is told in a story, with its segment."""
    story = told(name)
    for known, explanation in zip(story.known, story.explanations, strict=True):
        for each in explanation.reason.with_sentences().walk():
            yield known, each


@pytest.mark.parametrize("name", STORIES)
def test_every_sentence_of_every_segment_is_true(name: str) -> None:
    distinct = {
        (known.segment.ee, known.segment.index, each.sentence): known
        for known, each in reasons(name)
    }
    for (ee, index, sentence), known in distinct.items():
        _, check, arguments = form(sentence)
        assert check(known, *arguments), f"{ee}/{index}: {sentence}"
    assert len(distinct) > len(told(name).known)


def test_no_recomputation_accepts_whatever_it_is_given() -> None:
    """Of other segments, or some time later, sentences of each form are found to be false."""
    accepted: dict[str, int] = defaultdict(int)
    rejected: set[str] = set()
    for name in STORIES:
        for known, each in reasons(name):
            pattern, *_ = form(each.sentence)
            if pattern not in rejected and accepted[pattern] < 60:
                accepted[pattern] += 1
                if any(not holds(other, text) for other, text in altered(known, each.sentence)):
                    rejected.add(pattern)
    assert set(accepted) - rejected == set(TRUE_OF_ANY_SEGMENT)


def altered(known: Known, sentence: str) -> Iterator[tuple[Known, str]]:
    """The sentence of the capture's other segments, with its times moved, with other numbers."""
    for each in told_beside(known):
        yield each, sentence
    for shift in (-1.0, -0.4, 0.4, 0.7, 1.5):
        moved = later(sentence, shift)
        if moved != sentence:
            yield known, moved
    if told := re.search(r"(-?\d+) (mm/s|thousandths)", sentence):
        yield known, sentence.replace(told[0], f"{2 * abs(int(told[1])) + 900} {told[2]}")
    if "level" in sentence:
        yield known, re.sub(r"level \d", "level 4", sentence)


def later(sentence: str, shift_s: float) -> str:
    """The sentence with all its times moved."""
    return re.sub(
        r"\d+\.\d\d(?= s)", lambda at: f"{max(float(at[0]) + shift_s, 0.0):.2f}", sentence
    )


def told_beside(known: Known) -> Iterator[Known]:
    for each in known.seen.observation.segments:
        if each.ee == known.segment.ee and each.index != known.segment.index:
            yield replace(known, segment=each)


def holds(known: Known, sentence: str) -> bool:
    _, check, arguments = form(sentence)
    try:
        return check(known, *arguments)
    except (ValueError, IndexError):
        return False


def test_every_template_of_what_holds_is_told_or_said_to_be_of_no_name() -> None:
    known: dict[tuple[bool, str], set[str]] = defaultdict(set)
    for name in STORIES:
        for _, each in reasons(name):
            absent = each.atom.startswith("not ")
            predicate = each.atom.removeprefix("not ").split("(")[0]
            known[absent, predicate].add(each.sentence)
    templates = rule_base(profile()).sentences.templates
    untold = {
        key
        for key, template in templates.items()
        if key[0] in ("", "not", "mended")
        and not any(map(shape(template).fullmatch, known[key[0] == "not", key[1]]))
    }
    assert untold == set(TOLD_OF_NO_NAME)


def shape(template: Template) -> re.Pattern[str]:
    """What a template's sentences look like."""
    parts = re.split(r"\{[^}]*\}", template.text)
    return re.compile(".*".join(map(re.escape, parts)))


@pytest.mark.parametrize("name", STORIES)
def test_every_leaf_with_a_time_is_linked_to_its_frames(name: str) -> None:
    known = told(name).known[0]
    stretches = {
        (each.first, each.last)
        for each in (*known.facts, *known.seen.observation.facts)
        if hasattr(each, "first") and hasattr(each, "last")
    }
    for _, each in reasons(name):
        if "was measured from" in each.sentence:
            assert each.frames in stretches


@pytest.mark.parametrize("name", STORIES)
def test_the_summary_names_the_segment_and_its_reasons(name: str) -> None:
    for known, found in zip(told(name).known, told(name).explanations, strict=True):
        though = r"(, though [^.;]*)?"
        names = rf"(, and not \w+(, \w+)*(,? or (its kinds? )?\w+)*((,| and) \w+)*{though})?"
        kind = r"(, a kind of \w+(?: and \w+)?)?"
        opening = rf"{known.segment.name}{kind}{names},? because "
        assert re.match(opening, found.summary)
        assert found.summary.endswith(".")


@pytest.mark.parametrize("name", ["flickering", "chattering"])
def test_below_what_was_mended_stands_each_doubt_of_it_in_the_segment(name: str) -> None:
    story = told(name)
    doubts = [each for each in story.seen.observation.facts if isinstance(each, FlickerCorrection)]
    count = 0
    for known, explanation in zip(story.known, story.explanations, strict=True):
        first, last = known.segment.first, known.segment.last
        met: set[str] = set()
        for each in explanation.reason.with_sentences().walk():
            if "was taken to last" not in each.sentence or each.sentence in met:
                continue
            met.add(each.sentence)
            assert each.frames
            inside = {
                (doubt.first, doubt.last)
                for doubt in doubts
                if each.atom.startswith(ATOMS.get(doubt.taken, "!").format(doubt=doubt))
                and each.frames[0] <= doubt.first <= doubt.last <= each.frames[1]
                and first <= doubt.first <= doubt.last <= last
            }
            assert inside <= {below.frames for below in each.because}
            count += len(inside)
    assert count


ATOMS = {
    "touching": "touching({doubt.body},{doubt.other},",
    "moving": "moving({doubt.body},",
    "resting": "resting({doubt.body},",
}
"""How the atom begins that a doubt is of, by what it is taken for."""


def test_what_is_asked_of_the_solver_does_not_grow_with_the_capture() -> None:
    capture = motions.touch_cycle(motions.TALL_MAN).capture
    facts = measure(capture).facts
    sizes = []
    for copies in (1, 40):
        longer = repeated(facts, copies)
        rules = profile()
        explainer = Explainer(longer, profile=rules)
        segments = infer(longer, profile=rules).links[0].segments
        touch = next(each for each in segments if each.name == "Touch")
        assert explainer.explain(touch).name == "Touch"
        sizes.append(len(next(iter(explainer.windows_of(touch.ee, explainer.ticks(touch))))))
    assert sizes[1] <= sizes[0] + 20


def repeated(facts: tuple[Fact, ...], copies: int) -> tuple[Fact, ...]:
    """The same trial again and again, one after the other."""
    length = next(each.last for each in facts if isinstance(each, Frames)) + 1
    out: set[Fact] = {Frames(0, copies * length - 1)}
    for fact in facts:
        if isinstance(fact, Frames):
            continue
        keys = [key for key in ("first", "last", "frame") if hasattr(fact, key)]
        shifts = range(copies) if keys else (0,)
        out |= {
            replace(fact, **{key: getattr(fact, key) + copy * length for key in keys})
            for copy in shifts
            if not (isinstance(fact, Touching) and fact.body == "box" and copy)
        }
    box = next(each for each in facts if isinstance(each, Touching) and each.body == "box")
    out.discard(box)
    out.add(replace(box, last=copies * length - 1))
    return tuple(sorted(out, key=lambda each: (type(each).predicate, each)))


def test_an_unknown_segment_is_told_how_far_it_agreed() -> None:
    capture = motions.slide_object(motions.TALL_MAN).capture
    seen = explained(capture, rules=profile("thesis"))
    facts = [each for each in measure(capture).facts if not isinstance(each, ZeroCrossing)]
    crossings = [ZeroCrossing("right_hand", frame) for frame in (0, 227)]
    rules = profile("thesis")
    links = infer((*facts, *crossings), profile=rules).links
    unknown = [each for each in links[0].segments if not each.known]
    explainer = Explainer((*facts, *crossings), profile=rules)
    assert seen.observation.segments
    for segment in unknown:
        assert explainer.explain(segment).summary.startswith("Unknown, because")
