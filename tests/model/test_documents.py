"""Documents of an observation: JSON, notices, PARs, addresses of segments, errors."""

import json
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.capture import Agent
from capar.model.errors import NEAREST, CaparError, ParError, UnknownNameError
from capar.model.json_form import (
    KINDS,
    document,
    from_json,
    published_schema,
    schema_text,
    to_json,
    value_from_json,
)
from capar.model.notices import KINDS as NOTICE_KINDS
from capar.model.notices import Notice, notice, read_notice
from capar.model.observation import (
    AddressError,
    Observation,
    SegmentAddress,
    find_segment,
    split_capture,
)
from capar.model.par import ComplexPar, FeatureSet, Ipar, LinkSteps, Relation, Step, Upar

OBSERVATIONS = [drink_from_mug(), pick_up_with_both_hands(), with_unknown()]
numbers = st.floats(allow_nan=False, allow_infinity=False)
words = st.text(max_size=12)


@pytest.mark.parametrize("seen", OBSERVATIONS, ids=lambda each: each.capture)
def test_an_observation_comes_back_whole(seen: Observation) -> None:
    assert from_json(to_json(seen)) == seen


@pytest.mark.parametrize("seen", OBSERVATIONS, ids=lambda each: each.capture)
def test_what_is_written_obeys_the_published_schema(seen: Observation) -> None:
    published = json.loads(published_schema("observation"))
    Draft202012Validator(published).validate(json.loads(to_json(seen)))


@pytest.mark.parametrize("name", KINDS)
def test_the_published_schema_is_the_one_of_the_types(name: str) -> None:
    Draft202012Validator.check_schema(json.loads(published_schema(name)))
    assert published_schema(name) == schema_text(name)


def test_each_par_comes_back_alone_and_obeys_its_schema() -> None:
    seen = drink_from_mug()
    for name, kind, par in (
        ("upar", Upar, seen.upars[0]),
        ("ipar", Ipar, seen.ipars[1]),
        ("complex_par", ComplexPar, seen.complex_par),
    ):
        Draft202012Validator(json.loads(published_schema(name))).validate(document(par))
        assert value_from_json(to_json(par), kind) == par  # type: ignore[type-var]


def _steps(ee: str) -> st.SearchStrategy[Step]:
    return st.builds(
        Step,
        action=words,
        ee=st.just(ee),
        objects=st.lists(words).map(tuple),
        share=numbers,
        purpose=words,
        begin=numbers,
        segments=st.lists(st.integers(0, 99)).map(tuple),
        posture=words,
    )


places = st.tuples(words, st.integers(0, 99))
complex_pars = st.builds(
    ComplexPar,
    name=words,
    objects=st.lists(words).map(tuple),
    duration_s=numbers,
    links=st.lists(
        st.builds(LinkSteps, ee=words, steps=st.lists(_steps("hand"), max_size=3).map(tuple)),
        max_size=3,
    ).map(tuple),
    common=st.none() | _steps("all"),
    relations=st.lists(st.builds(Relation, places, words, places), max_size=3).map(tuple),
)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(complex_pars)
def test_every_complex_par_comes_back_to_the_last_bit(par: ComplexPar) -> None:
    text = to_json(par)
    assert value_from_json(text, ComplexPar) == par
    assert to_json(value_from_json(text, ComplexPar)) == text


@settings(max_examples=30, deadline=None)
@given(st.dictionaries(words, numbers, max_size=5), words)
def test_measures_come_back_whatever_they_are_called(measures: dict[str, float], name: str) -> None:
    seen = replace(drink_from_mug(), agent=Agent(name, "person", measures))
    assert from_json(to_json(seen)) == seen


def _broken(place: str, value: object) -> str:
    """A good document with another value at one place; an ellipsis takes the key away."""
    content = json.loads(to_json(drink_from_mug()))
    *way, last = [int(each) if each.isdigit() else each for each in place.split(".")]
    inner = content
    for each in way:
        inner = inner[each]
    if value is ...:
        del inner[last]
    else:
        inner[last] = value
    return json.dumps(content)


@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        ("capture", ..., "a.json: capture: expected a value, found none"),
        ("colour", "red", "a.json: colour: no such field"),
        ("links.0.segments.2.first", "1", "links.0.segments.2.first: expected a valid integer"),
        ("links.0.segments.2.possessed", 1, "links.0.segments.2.possessed: expected"),
        ("upars.0.core.motion", "dance", "upars.0.core.motion: expected 'none'"),
        ("ipars.0.core.constraint.features.force", "11", "ipars.0.core.constraint.features: "),
        ("facts.3", "touching(a", "facts.3: expected an atom"),
        ("facts.3", "dances(agent)", "facts.3: 'dances(agent)' is no measured fact"),
        ("facts.3", "tag(mug)", "facts.3: tag(mug) is no tag/2"),
        ("facts", 3, "facts: expected a list of atoms, found 3"),
    ],
)
def test_bad_json_is_refused_with_its_place(place: str, value: object, says: str) -> None:
    with pytest.raises(ParError) as raised:
        from_json(_broken(place, value), where="a.json")
    assert says in str(raised.value)
    assert str(raised.value).startswith("a.json: ")


@pytest.mark.parametrize("text", ["", "{", "[]", "3", "null", "[" * 100_000])
def test_what_is_no_document_is_refused(text: str) -> None:
    with pytest.raises(ParError):
        from_json(text)


def test_a_number_that_json_lacks_is_refused_with_its_place() -> None:
    seen = replace(drink_from_mug(), rate_hz=float("nan"))
    with pytest.raises(ParError, match=r"Observation\.rate_hz: nan"):
        to_json(seen)


ONE_OF_EACH = (
    notice("contact-tolerance", tolerance_m=0.0051, stated=False),
    notice("contact-tolerance", tolerance_m=0.01, stated=True),
    notice("pivot-distance", "hand", "mug", distance_m=0.12),
    notice("touch-estimated", "hand", "mug", touch_m=0.0312, found="co-motion", frames=80),
    notice("distance-contradicted", "hand", "mug", touch_m=0.05, shown_m=0.12, frames=80),
    notice("mount-gap", "hand", "mug", touch_m=0.005, shown_m=0.0304, frames=80),
    notice(
        "guide",
        "lid",
        "box",
        kind="hinge",
        axis="0.00, 1.00, 0.00",
        opened_deg=70.0,
        residual_m=0.001,
    ),
    notice(
        "guide",
        "tray",
        "box",
        kind="track",
        axis="1.00, 0.00, 0.00",
        opened_m=0.2,
        residual_m=0.001,
    ),
    notice("no-mover", "mug", start_s=1.0, end_s=2.5, share=0.25, times=2, why="nobody"),
    notice("contact-gap", "mug", "hand", start_s=1.0, end_s=2.5, called="right hand"),
    notice(
        "up-contradicted",
        "ball",
        start_s=1.0,
        end_s=1.5,
        shown="fall",
        angle_deg=90.0,
        up="y",
        declared="z",
    ),
    notice(
        "up-contradicted",
        "ball",
        start_s=1.0,
        end_s=1.5,
        shown="fall",
        angle_deg=41.0,
        up="",
        declared="z",
    ),
    notice("up-contradicted", "mug", "table", shown="rest", where="under", up="-z", declared="z"),
    notice(
        "unit-contradicted",
        "head",
        "foot",
        start_s=1.0,
        end_s=1.0,
        shown="person",
        size_m=0.14,
        unit="cm",
        declared="mm",
    ),
    notice("unit-contradicted", "hand", shown="speed", speed_mps=900.0, unit="mm", declared="m"),
    notice(
        "unit-contradicted",
        "ball",
        start_s=1.0,
        end_s=1.5,
        shown="fall",
        acceleration_mps2=9810.0,
        unit="mm",
        declared="m",
    ),
    notice(
        "fall-rate",
        "ball",
        start_s=1.0,
        end_s=1.5,
        acceleration_mps2=39.2,
        rate_hz=60.0,
        declared_hz=120.0,
    ),
    notice("shape-size", "mug", shape="mug.obj", size_m=110.0, unit="mm"),
    notice("sides-exchanged", "right_hand", "left_hand", "head", share=0.97),
    notice(
        "order-contradicted",
        "Hand",
        "Mug",
        declared="xyzw",
        order="wxyz",
        stray_m=0.14,
        stretches=3,
    ),
    notice("no-shape", "mug"),
    notice("stand-in-shape", "mug", shape="ball of {radius}"),
    notice("assumed-support", "table", assumed="a box"),
    notice("moving-ground", "floor", agent="guest", speed_mps=1.129),
    notice("long-gap", "mug"),
    notice("long-gap", "mug", start_s=0.5, end_s=0.994),
    notice("long-gap", "mug", times=1, fixed=False),
    notice("long-gap", "mug", start_s=1.0, end_s=2.0, times=1, fixed=True),
    notice("long-gap", "mug", start_s=1.0, end_s=2.0, times=3, fixed=False),
    notice("markers-not-rigid", "mug", frames=3),
    notice("bone-stretches", "hand", "wrist", "index", shortest_m=0.4, longest_m=0.7),
    notice("objects-left-out", "a", "b", objects=9),
    notice("doubled-stamps", samples=4),
    notice("flicker", "hand", "mug", start_s=1.0, end_s=1.1, length_s=0.1, taken="apart"),
    notice("flicker", "mug", start_s=1.0, end_s=1.1, length_s=0.1, taken="still"),
    notice("sensors-grouped", "right_foot", sensors="right_heel, right_toe"),
    notice("no-unit"),
    notice("offset-and-position", "hip", "knee"),
    notice("rate-mistyped", stated_hz=1000.0, recorded_hz="100"),
    notice("rate-contradicted", stated_hz=250.0, rate_hz=50.0),
    notice("frames-missing", stated="900", frames=12),
    notice("end-effector-unknown", "hand", stated="hnd", known="hand, foot", near="hand"),
    notice("mesh-not-closed", "cup", mesh="cup.obj", edges=6),
    notice("rule-violation", violation="violation(x)"),
    notice("nothing-acts"),
)


@pytest.mark.parametrize("each", ONE_OF_EACH, ids=lambda each: each.code)
def test_its_message_names_its_bodies(each: Notice) -> None:
    assert all(body in each.message for body in each.bodies)


def test_every_code_is_told_here() -> None:
    assert {each.code for each in ONE_OF_EACH} == set(NOTICE_KINDS)


@pytest.mark.parametrize("each", ONE_OF_EACH, ids=lambda each: each.code)
def test_it_comes_back_from_json(each: Notice) -> None:
    assert read_notice(json.loads(json.dumps(each.document()))) == each


def test_an_unknown_code_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(UnknownNameError, match=r"no kind of notice 'long_gap'.*'long-gap'"):
        notice("long_gap", "mug")


@pytest.mark.parametrize(
    "make",
    [
        lambda: notice("stand-in-shape", "mug"),
        lambda: notice("stand-in-shape", shape="ball"),
        lambda: notice("pivot-distance", "mug", distance_m=0.1),
        lambda: notice("flicker", "mug", length_s=0.1, taken="still"),
    ],
)
def test_a_notice_without_what_its_sentence_needs_is_refused(make: object) -> None:
    with pytest.raises(CaparError, match="lacks a field"):
        make()  # type: ignore[operator]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"code": 3}, "code: expected a text"),
        ({"bodies": "mug"}, "bodies: expected a list of names"),
        ({"values": []}, "values: expected names"),
        ({"start_s": "now"}, "expected seconds"),
        ({"body": "mug"}, "no field of a notice 'body'"),
    ],
)
def test_a_wrong_document_is_refused_with_what_was_expected(
    changed: dict[str, object], message: str
) -> None:
    right = notice("stand-in-shape", "mug", shape="ball").document()
    with pytest.raises(CaparError, match=message):
        read_notice({**right, **changed})


@given(st.integers(0, 6), st.integers(0, 6), st.integers(0, 6), st.integers(0, 6))
def test_feature_strings_agree_in_length_or_are_refused(a: int, b: int, c: int, d: int) -> None:
    good = (a, b, d) == ((2 * c - 1, 2 * c - 1, c) if c else (0, 0, 0))
    if good:
        assert FeatureSet("1" * a, "1" * b, "0" * c, "hand", "0" * d).count == c
    else:
        with pytest.raises(ParError):
            FeatureSet("1" * a, "1" * b, "0" * c, "hand", "0" * d)


def test_another_performer_and_other_durations_are_the_same_action() -> None:
    par = drink_from_mug().complex_par
    assert drink_from_mug(agent="somebody").complex_par.signature == par.signature
    assert replace(par, duration_s=99.0).signature == par.signature


def test_other_names_of_the_objects_are_the_same_action() -> None:
    par = drink_from_mug().complex_par
    new = {"mug": "cup", "mouth": "lips", "table": "desk"}

    def renamed(step: Step) -> Step:
        return replace(step, objects=tuple(new[each] for each in step.objects))

    other = replace(
        par,
        objects=tuple(new[each] for each in par.objects),
        links=tuple(replace(each, steps=tuple(map(renamed, each.steps))) for each in par.links),
        common=renamed(par.common) if par.common else None,
    )
    assert other != par
    assert other.signature == par.signature


def test_the_common_step_belongs_to_every_link() -> None:
    for _, steps in pick_up_with_both_hands().complex_par.signature:
        assert steps[-1] == ("ResumePosture", (0,))


segment_address_words = st.text(
    st.characters(exclude_characters="/", exclude_categories=["Cs", "Z", "C"]), min_size=1
)
captures = st.lists(segment_address_words, max_size=3).map("/".join)


@given(segment_address_words, st.integers(0, 10**6), captures)
def test_an_address_reads_back_as_it_was_written(ee: str, index: int, capture: str) -> None:
    address = SegmentAddress(ee, index, capture)
    assert SegmentAddress.parse(str(address)) == address


@pytest.mark.parametrize(
    "text",
    ["", "3", "right_hand", "right_hand/", "/3", "a//3", "right_hand/-1", "a/x", "a:b:3", "a/²"],
)
def test_a_text_that_is_no_address_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(AddressError, match="write CAPTURE/END_EFFECTOR/INDEX, such as "):
        SegmentAddress.parse(text)


def test_each_segment_is_found_with_and_without_its_capture() -> None:
    seen = drink_from_mug()
    for segment in seen.segments:
        for capture in ("", seen.capture):
            address = SegmentAddress(segment.ee, segment.index, capture)
            assert find_segment(seen.links, address, capture=seen.capture) is segment


def test_another_capture_or_segment_is_refused_with_those_there_are() -> None:
    seen = drink_from_mug()
    with pytest.raises(UnknownNameError, match="no capture 'Other'; there are: DrinkFromMug"):
        find_segment(seen.links, SegmentAddress.parse("Other/right_hand/0"), capture=seen.capture)
    with pytest.raises(UnknownNameError, match="no segment 'right_hand/99'; there are: "):
        find_segment(seen.links, SegmentAddress("right_hand", 99), capture=seen.capture)


def test_a_capture_is_demanded_where_there_may_be_several() -> None:
    assert split_capture("a/b:c/hand/3") == ("a/b:c", SegmentAddress("hand", 3))
    with pytest.raises(AddressError, match="names no capture"):
        split_capture("hand/3")


def test_of_many_names_the_nearest_five_are_listed_and_all_are_counted() -> None:
    names = [f"marker_{number:03d}" for number in range(164)] + ["right_hand"]
    error = UnknownNameError("body", "rigth_hand", names)
    text = str(error)
    assert text.startswith("no body 'rigth_hand'; there are 165, the nearest: right_hand, ")
    assert text.endswith("Did you mean 'right_hand'?")
    assert text.count(",") == NEAREST
    assert error.known == sorted(names)
