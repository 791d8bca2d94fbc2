"""First drafts of rules: from a feature set, or from a segment of a capture."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from capar.model.errors import RuleError, UnknownNameError
from capar.model.facts import Fact
from capar.model.observation import ObservedLink, Segment, find_segment, split_capture
from capar.model.par import FeatureSet
from capar.pipelines.observation import facts_program
from capar_rules.authoring.drafting import bits_of, excerpt, fitting, rule_telling
from capar_rules.authoring.user_primitives import LACKING, Example, new_rule, rules_of, written
from capar_rules.borders.numbering import Tick, number_borders
from capar_rules.engine.profiles import Profile, profile
from capar_rules.engine.syntax import parse, parse_text
from capar_rules.lint.checking import admitted_profile
from capar_rules.lint.text_checks import known
from capar_rules.lint.world_checks import rivals
from capar_rules.pars.inference import infer
from extractors.readers.bundle.capture_toml import read_capture
from kb.actionary import Actionary
from kb.encode.observation import stored_facts


def rule_from_features(
    name: str,
    features: str,
    *,
    rules: Profile,
    definition: str = "",
    general: str = "",
    verb: str = "",
) -> str:
    """A rule file for the feature set that a user writes: ``100,101,10,00``.

    Raises:
        RuleError: It is no feature set, or the name is taken.
        UnknownNameError: There is no such primitive to specialise.
        ParError: Its strings do not belong together.
    """
    parts = [each.strip() for each in features.split(",")]
    if len(parts) != 4:
        raise RuleError(f"{features!r} is no feature set; write START,END,CHANGE,FORCE")
    _free(name, general, rules)
    start, end, change, force = parts
    found = FeatureSet(start, end, change, "any", force)
    over = (general,) if general else ()
    return _ordered(name, found, rules, over=over, definition=definition, verb=verb) + LACKING


def rule_from_segment(
    name: str,
    source: str,
    *,
    rules: Profile,
    actionary: str | None = None,
    definition: str = "",
    general: str = "",
    verb: str = "",
) -> str:
    """The smallest rule file that tells an observed segment from its capture's others.

    Args:
        name: What the primitive is called.
        source: CAPTURE/END_EFFECTOR/INDEX; segments are counted as `capar observe` counts them.
        rules: The rules by which the capture is cut into segments, and which it is to join.
        actionary: An Actionary that may hold an observation of that name; None for none.
        definition: What it is, in words.
        general: The primitive that it specialises; if empty, what names the segment now.
        verb: The verb for it.

    Raises:
        AddressError: The source is no address of a segment.
        RuleError: The name is taken.
        UnknownNameError: There is no such segment, or no such primitive to specialise.
        CaparError: The capture cannot be read.
    """
    capture, place = split_capture(source)
    _free(name, general, rules)
    called, measured = _measured(capture, rules, actionary)
    links = infer(measured, profile=rules).links
    segment = find_segment(links, place, capture=called)
    more = general or (segment.name if segment.known else "")
    smallest = _smallest(name, measured, segment, rules, general=more)
    text = _ordered(
        name, segment.features, rules, over=(more,) if more else (), definition=definition,
        verb=verb, rule=smallest,
    )  # fmt: skip
    examples = _examples(text, name, called, measured, segment, rules)
    return "\n".join([text if len(examples) > 1 else text + LACKING, *examples])


def _smallest(
    name: str, measured: Sequence[Fact], segment: Segment, rules: Profile, *, general: str
) -> str:
    """The rule of the fewest conditions that tell the segment from the capture's others.

    Empty if the rules have no words for what tells it: its row of features has to do.
    """
    bits = bits_of(measured, rules)
    numbers = number_borders(measured, crossings_only=rules.crossings_only)
    (tick,) = {
        each.tick
        for each in numbers
        if isinstance(each, Tick) and (each.ee, each.frame) == (segment.ee, segment.first)
    }
    own = bits[segment.ee, tick]
    others = [each for place, each in sorted(bits.items()) if place != (segment.ee, tick)]
    given = [each for each in (fitting(general),) if general and each in own]
    return rule_telling(name, own, others, given=given)


def _examples(
    text: str, name: str, called: str, measured: Sequence[Fact], segment: Segment, rules: Profile
) -> list[str]:
    """A short example of the segment, and a counter-example of one that the draft does not name."""
    with TemporaryDirectory() as folder:
        draft = Path(folder) / f"{name}.lp"
        draft.write_text(text, encoding="utf-8")
        joined = admitted_profile(rules.name, added=(*rules.added, draft), steady=rules.steady)
        links = infer(measured, profile=joined).links
        out = []
        for link, each in _shown(links, segment, name):
            short = excerpt(measured, link, each, rules=joined, name=name)
            facts, names = short or (tuple(measured), tuple(one.name for one in link.segments))
            positive = each.name == name
            if positive or name not in names:
                story = (
                    f"{called}, {each.ee}/{each.index}, {each.start_s:.2f} to {each.end_s:.2f} s."
                )
                out.append(written(Example(story, positive, facts, ((link.ee, names),), 0)))
        return out


def _shown(
    links: Sequence[ObservedLink], segment: Segment, name: str
) -> Iterator[tuple[ObservedLink, Segment]]:
    """The segment itself, and the likest other one, if possible far from each of that name."""
    (own,) = [each for each in links if each.ee == segment.ee]
    (same,) = [each for each in own.segments if each.first == segment.first]
    yield own, same
    far = [
        each
        for at, each in enumerate(own.segments)
        if all(one.name != name for one in own.segments[max(at - 1, 0) : at + 2])
    ]
    others = far or [segment for segment in own.segments if segment.name != name]
    if others:
        yield own, max(others, key=lambda e: (e.name == segment.name, e.known, -e.index))


def _free(name: str, general: str, rules: Profile) -> None:
    taken = {each.name: each.file for each in rules_of(rules)}
    if name in taken:
        raise RuleError(
            f"there is a primitive {name!r} already, in {taken[name]}; choose another name"
        )
    if general and general not in taken:
        raise UnknownNameError("primitive", general, taken)


def _measured(capture: str, rules: Profile, actionary: str | None) -> tuple[str, tuple[Fact, ...]]:
    """A capture's name and its facts: as it is read now, or as they are stored."""
    if actionary is not None and not Path(capture).exists():
        with Actionary.open(actionary, read_only=True) as store:
            for stored in store.observations():
                if stored.name == capture:
                    if stored.profile != rules.name:
                        raise RuleError(
                            f"{capture!r} was observed with the profile {stored.profile}, and is "
                            f"cut into segments otherwise by {rules.name}; say --profile "
                            f"{stored.profile}"
                        )
                    return capture, stored_facts(store.store, capture)
    trial = read_capture(capture)
    return trial.name, facts_program(trial, rules=rules)[0].facts


def _ordered(
    name: str,
    features: FeatureSet,
    rules: Profile,
    *,
    over: Sequence[str],
    definition: str,
    verb: str,
    rule: str = "",
) -> str:
    """A rule that is more specific than everything that it shares a segment with."""
    text = new_rule(name, features, definition=definition, general=over, verb=verb, rule=rule)
    base = known(parse(profile(rules.name).files))
    mine = parse(rules.added) if rules.added else ()
    others = rivals(name, parse_text(text), base, mine)
    return new_rule(
        name, features, definition=definition, general=over, verb=verb, besides=others, rule=rule
    )
