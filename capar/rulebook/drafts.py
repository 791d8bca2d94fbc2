"""First drafts of rules: from a feature set, or from a segment of a capture."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from capar.model.errors import RuleError, UnknownNameError
from capar.model.facts import Fact
from capar.model.observation import ObservedLink
from capar.model.par import FeatureSet
from capar.model.segment_address import find_segment, split_capture
from capar.pipelines.observation import facts_program
from capar_rules.authoring.examples import Example, try_examples, written
from capar_rules.authoring.user_primitives import new_rule, rules_of, telling
from capar_rules.engine.profiles import Profile, profile
from capar_rules.engine.syntax import parse, parse_text
from capar_rules.lint.admission import admitted_profile
from capar_rules.lint.name_checks import rivals
from capar_rules.lint.text_checks import known
from capar_rules.pars.inference import infer
from extractors.readers.bundle.capture_toml import read_capture
from kb.actionary import Actionary
from kb.lookup.facts import facts


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

    Args:
        name: What the primitive is called.
        features: START, END, CHANGE and FORCE in bits.
        rules: The rules that it is to join.
        definition: What it is, in words.
        general: The primitive that it specialises.
        verb: The verb for it.

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
    return _ordered(name, found, rules, over=over, definition=definition, verb=verb)


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
    """A rule file for the features of an observed segment, with its capture as an example.

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
    over = (more,) if more else ()
    text = _ordered(name, segment.features, rules, over=over, definition=definition, verb=verb)
    with TemporaryDirectory() as folder:
        draft = Path(folder) / f"{name}.lp"
        draft.write_text(text, encoding="utf-8")
        joined = admitted_profile(rules.name, added=(*rules.added, draft), steady=rules.steady)
        story = Example(f"{called}, segment {place}.", True, _told(measured, links, rules), (), 0)
        (outcome,) = try_examples([story], profile=joined)
    example = Example(story.story, True, story.facts, outcome.found, 0)
    return f"{text}\n{written(example)}"


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
                    return capture, facts(store.store, capture)
    trial = read_capture(capture)
    return trial.name, facts_program(trial, rules=rules)[0].facts


def _told(
    measured: tuple[Fact, ...], links: Sequence[ObservedLink], rules: Profile
) -> tuple[Fact, ...]:
    """Contacts and motions alone, if they make the same segments of the same names; else all."""
    few = telling(measured)
    return few if _outline(infer(few, profile=rules).links) == _outline(links) else measured


def _outline(links: Sequence[ObservedLink]) -> list[tuple[str, int, int, str]]:
    return [(each.ee, each.first, each.last, each.name) for one in links for each in one.segments]


def _ordered(
    name: str,
    features: FeatureSet,
    rules: Profile,
    *,
    over: Sequence[str],
    definition: str,
    verb: str,
) -> str:
    """A rule that is more specific than everything that it shares a segment with."""
    text = new_rule(name, features, definition=definition, general=over, verb=verb)
    base = known(parse(profile(rules.name).files))
    mine = parse(rules.added) if rules.added else ()
    others = rivals(name, parse_text(text), base, mine)
    return new_rule(name, features, definition=definition, general=over, verb=verb, besides=others)
