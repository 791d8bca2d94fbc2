"""Language: describe a capture, read sentences, look verbs up, report on them and on corpora."""

from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli import options
from capar.cli.output import answer, check_picture, check_writable, emit, save
from capar.model.errors import CaparError, UnknownNameError

if TYPE_CHECKING:
    from capar.model.observation import Observation
    from kb.language import Question
    from kb.lexicon.verbs import Fit, VerbAnswer
    from kb.store.stores import Store


class Detail(StrEnum):
    """How much is described."""

    STEPS = "steps"
    SUMMARY = "summary"


def describe(
    capture: options.Capture,
    detail: Annotated[Detail, Option(help="Every step, or what changed.")] = Detail.STEPS,
    timed: Annotated[bool, Option("--timed", help="Say when each step was.")] = False,
    profile: options.ProfileName = "extended",
    corrected: options.Corrected = False,
    rules: options.Rules = None,
    actionary: options.Beside = None,
    json: options.Json = False,
) -> None:
    """Say in plain English what was done in a capture."""
    from capar.pipelines.observation import observe
    from capar.views.notices import reservation_lines, reservations_on_told
    from kb.language.describe import describe as told
    from kb.language.describe import nouns

    observation = observe(capture, rules=options.rule_base(profile, rules, actionary))
    if corrected:
        observation = _corrected(observation, actionary)
    words = options.rule_words(rules, actionary)
    text = told(observation, detail=detail.value, timed=timed, words=words)
    notices = reservations_on_told(observation)
    told_of = {"capture": observation.capture, "description": text}
    value = {**told_of, "notices": [each.document() for each in notices]}
    lines = (text, *reservation_lines(notices, called=nouns(observation.objects)))
    answer(value, lines, json=json, sort_keys=True)


def _corrected(observation: "Observation", actionary: str | None) -> "Observation":
    """The same with the segments that persons claim in an Actionary."""
    from kb import Actionary
    from kb.corrections import claims, corrected_links

    with Actionary.open(actionary, read_only=True) as opened:
        said = claims(opened.store, observation.capture)
    links = corrected_links(observation.links, said)
    return replace(observation, links=links, relations=(), joint=())


def parse(
    sentence: Annotated[str, Argument(help="Such as: pick up the mug and put it in the box")],
    actionary: options.Place = None,
    rules: options.Rules = None,
    json: options.Json = False,
) -> None:
    """Read instructions, a description, or a question in English.

    A question is one such as 'who moved the mug to the table?'.

    With an Actionary, objects and performers are those that it knows, and a question is answered;
    without one any noun will do.
    """
    from capar.pipelines.language import vocabulary
    from capar.views.readings import reading_lines
    from kb.language import Question
    from kb.language import parse as read

    words = options.rule_words(rules, options.opened(actionary))
    with options.open_words(actionary) as store:
        value = read(sentence, vocabulary(words, store))
        if isinstance(value, Question):
            _answer_question(value, store, json=json)
        else:
            answer(value, reading_lines(value), json=json, sort_keys=True)


def _answer_question(value: "Question", store: "Store | None", *, json: bool) -> None:
    from capar.views.readings import answer_lines, question_lines

    queries = (value.sparql, *value.others)
    names = (value.about, *value.alternatives, *value.also)
    answers: list[list[Any]] | None = None
    lines = [*question_lines(value)]
    if store is None:
        lines += queries
    else:
        answers = [list(value.chosen(list(store.ask(each).plain()))) for each in queries]
        for about, rows in zip(names, answers, strict=True):
            lines += answer_lines(value, about, rows)
    document = {
        "asks": value.ask.value,
        "about": value.about,
        "sparql": value.sparql,
        "rank": value.rank,
        "others": names[1:],
        "answers": answers and answers[0],
        "other_answers": answers and answers[1:],
    }
    answer(document, lines, json=json, sort_keys=True)


FIRST_SENSES = 4
"""How many of a verb's most frequent senses are shown beside those as a motion."""


def verb(
    lemma: Annotated[str, Argument(help="A verb, such as carry or 'pick up'.")] = "",
    segment: Annotated[
        str, Option("--for", help="CAPTURE/END_EFFECTOR/INDEX: verbs of a segment.")
    ] = "",
    kinds: Annotated[bool, Option("--kinds", help="Primitives of it and its kinds.")] = False,
    actionary: options.Place = None,
    rules: options.Rules = None,
    most: Annotated[int, Option(help="How many verbs of a segment to show.", min=1)] = 15,
    json: options.Json = False,
) -> None:
    """Say what is known of a verb, or which verbs fit a segment.

    That is its senses, classes, roles, primitives, and where it was seen.
    """
    if bool(lemma) == bool(segment):
        raise CaparError("name a verb, or a segment with --for CAPTURE/END_EFFECTOR/INDEX")
    from capar.pipelines.language import verbs_for
    from capar.pipelines.linguistic_report import answer_verb
    from kb.lexicon.verbs import doubts_of, keys_of_primitives, often, seen_in, summed
    from kb.lexicon.verbs import kinds as kinds_of

    place = options.opened(actionary)
    words = options.rule_words(rules, place)
    value: Any
    with options.open_words(actionary) as store:
        if segment:
            base = options.rule_base("extended", rules, place)
            value = verbs_for(segment, words, store=store, rules=base)[:most]
            lines = _fit_lines(value)
        elif kinds:
            names = kinds_of(lemma, keys_of_primitives(words))
            seen = [each for each in (seen_in(store) if store else ()) if each.primitive in names]
            value = {"verb": lemma, "primitives": names, "seen": seen}
            lines = [f"{lemma}, and every kind of it: {', '.join(names) or 'no primitive'}"]
            lines += [f"  {r.observation}: {r.primitive}, {often(r.count)}" for r in summed(seen)]
        else:
            for doubt in doubts_of(words):
                typer.echo(f"note [unknown-word]: {doubt}", err=True)
            value = answer_verb(lemma, words, store=store)
            lines = _verb_lines(value)
    answer(value, lines, json=json, sort_keys=True)


def _fit_lines(fits: "tuple[Fit, ...]") -> list[str]:
    lines = []
    for number, each in enumerate(fits, 1):
        lines.append(f"{number:2d}. {each.verb}  ({each.source})")
        lines += [f"      + {reason}" for reason in each.reasons]
        lines += [f"      - {reason}" for reason in each.against]
    return lines


def _verb_lines(found: "VerbAnswer") -> list[str]:
    from kb.lexicon.verbs import often, summed

    lines = [f"{found.verb}: {found.standing.words}."]
    shown = [each for each in found.senses if each.motion or each.sense.number <= FIRST_SENSES]
    for each in shown:
        mark, gloss = "→" if each.motion else " ", each.synset.definition
        lines.append(f" {mark} {each.sense.number}. {gloss} {each.sense.key}")
    if len(shown) < len(found.senses):
        lines.append(f"   and {len(found.senses) - len(shown)} more senses (--json shows all)")
    for one in found.classes:
        title = f"Levin {one.levin.number} {one.levin.title}" if one.levin else "no Levin class"
        verbnet = f", VerbNet {one.verbnet}" if one.verbnet else ""
        lines.append(title + verbnet + (f": {', '.join(one.roles)}" if one.roles else ""))
        if one.frame and one.frame.example:
            meaning = " ".join(map(str, one.frame.semantics))
            lines.append(f"   “{one.frame.example}” {meaning}")
    if not any(one.verbnet for one in found.classes):
        lines.append("VerbNet's classes come with `capar lexicon import verbnet DIR`.")
    for near in found.neighbours:
        by = f" ({', '.join(near.primitives)})" if near.primitives else ""
        lines.append(f"{near.relation} {', '.join(near.verbs)}{by}: {near.definition}")
    for claim in found.claims:
        lines.append(f"Thesis {claim.section}: {claim.status.value}. {claim.reason}")
    for seen in summed(found.seen):
        lines.append(f"Seen: {seen.primitive} in {seen.observation}, {often(seen.count)}.")
    if found.general_seen:
        sums = summed(replace(each, observation="") for each in found.general_seen)
        every = ", ".join(f"{each.primitive} {often(each.count)}" for each in sums)
        lines.append(f"Not seen; what is more general was: {every}.")
    return lines


lexicon = typer.Typer(no_args_is_help=True, help="Words in an Actionary: WordNet, Levin, VerbNet.")


@lexicon.command()
def load(
    actionary: options.Place = None, rules: options.Rules = None, new: options.New = False
) -> None:
    """Load WordNet's verbs, Levin's classes and primitives' links, once."""
    from kb.actionary import Actionary
    from kb.lexicon.loading import load_words

    options.confirm_new(actionary, new=new)
    words = options.rule_words(rules, options.opened(actionary))
    with Actionary.open(actionary) as book:
        loaded = load_words(book.store, words)
    typer.echo("The words are loaded." if loaded else "The words were there already.")


@lexicon.command("import")
def import_words(
    source: Annotated[str, Argument(help="What to import: verbnet.")],
    folder: Annotated[Path, Argument(help="The folder with VerbNet's XML files.")],
    actionary: options.Place = None,
    new: options.New = False,
    json: options.Json = False,
) -> None:
    """Read VerbNet 3.x from your own copy, in place of an earlier one."""
    from kb.actionary import Actionary
    from kb.lexicon.loading import load_verbnet
    from kb.lexicon.verbnet import key_rate, read_verbnet
    from kb.lexicon.wordnet import wordnet

    if source != "verbnet":
        raise UnknownNameError("source of words", source, ("verbnet",))
    options.confirm_new(actionary, new=new)
    classes = read_verbnet(folder)
    keys, resolved = key_rate(classes, wordnet())
    with Actionary.open(actionary) as book:
        loaded = load_verbnet(book.store, classes, wordnet())
    every = [each for top in classes for each in top.family]
    members = sum(len(each.members) for each in every)
    figures = {
        "files": len(classes),
        "classes": len(every),
        "members": members,
        "keys": keys,
        "keys_resolved": resolved,
        "loaded": loaded,
    }
    lines = [
        f"{len(classes)} files with {len(every)} classes and {members} members; {resolved} of "
        f"{keys} WordNet keys ({100 * resolved / max(keys, 1):.1f} %) are in WordNet 3.1."
    ]
    lines += [] if loaded else ["The Actionary had them already."]
    answer(figures, lines, json=json, sort_keys=True)


report = typer.Typer(no_args_is_help=True, help="Reports over the rule base and an Actionary.")


@report.callback()
def _reports() -> None:
    """Reports over the rule base and an Actionary."""


class Format(StrEnum):
    """How a report is written."""

    TEXT = "text"
    MD = "md"
    HTML = "html"
    CSV = "csv"
    JSON = "json"


@report.command()
def linguistics(
    actionary: options.Place = None,
    form: Annotated[Format, Option("--format", help="How it is written.")] = Format.TEXT,
    rules: options.Rules = None,
    output: options.OutputFile = None,
    cases: Annotated[Path | None, Option(help="A folder of cases as proof.")] = None,
    corrected: options.Corrected = False,
    json: Annotated[bool, Option("--json", help="The same as --format json.")] = False,
) -> None:
    """Report which verbs and verb classes are addressed, with the proof."""
    from capar.pipelines.linguistic_report import cases_of, primitive_files
    from capar.pipelines.linguistic_report import linguistics as report_of
    from kb.reports.formats import write

    if output is not None:
        check_writable(output)
    files = primitive_files(options.rule_base("extended", rules, options.opened(actionary)).added)
    with options.open_words(actionary, corrected=corrected) as store:
        report = report_of(files, store=store, cases=cases_of(files, cases))
    emit(write(report, Format.JSON.value if json else form.value), output)


@report.command()
def corpus(
    actionary: options.Place = None,
    plot: options.Plot = None,
    corrected: options.Corrected = False,
    json: options.Json = False,
) -> None:
    """Report how often, how long and by whom actions were done, what follows what, and outliers.

    The same as `capar query` of statistics, sequences and outliers, which take filters.
    """
    from kb.queries.questions import as_table, question

    check_picture(plot)
    options.require_actionary(actionary, observed=True)
    with options.open_words(options.opened(actionary), corrected=corrected) as store:
        assert store is not None
        asked = {name: question(name) for name in ("statistics", "sequences", "outliers")}
        found = {name: store.ask(each.bind({})) for name, each in asked.items()}
    rows = {name: list(each.plain()) for name, each in found.items()}
    if plot:
        from capar.views.corpus import draw_corpus

        title = f"What was done in {options.opened(actionary)}"
        save(plot, lambda path: draw_corpus(title, rows, path), "drew")
    lines = (f"{asked[name].text}\n{as_table(each)}" for name, each in found.items())
    answer(rows, lines, json=json)
