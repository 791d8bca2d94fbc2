"""A complex action drawn: as text, as a picture in SVG, and as Turtle."""

from collections.abc import Iterable
from html import escape

from pyoxigraph import NamedNode, RdfFormat

from capar.model.errors import UnknownNameError
from capar.model.par import ComplexPar, Step
from kb.encode.complex_pars import COMMON
from kb.exchange import part
from kb.findings import Stored
from kb.lookup import stored_pars
from kb.lookup.stored import observations
from kb.reports import svg
from kb.store import names
from kb.store.answers import turtle
from kb.store.stores import Store
from ontology import CAPAR

WIDTH, ROW, LEFT, TOP = 900, 46, 130, 40
"""The picture's measures: whole width, height of a link, and margins [px]."""

COLOURS = ("#4e79a7", "#f28e2b", "#59a14f", "#e15759", "#76b7b2", "#edc948", "#b07aa1", "#9c755f")


def seen(store: Store, name: str) -> tuple[Stored, ...]:
    """The observations of a complex action, or the one of that name.

    Raises:
        UnknownNameError: There is none.
    """
    every = observations(store)
    found = tuple(each for each in every if each.name == name) or tuple(
        each for each in every if each.action == name
    )
    if not found:
        known = {each.name for each in every} | {each.action for each in every}
        raise UnknownNameError("complex action", name, known, where=store.place)
    return found


def as_text(store: Store, name: str) -> str:
    """The action's links and steps, and every observation of it with its shares of time."""
    found = seen(store, name)
    values = [stored_pars.complex_par(store, each.name) for each in found]
    first = values[0]
    lines = [f"{first.name}({', '.join(first.objects)})"]
    for ee, steps in _rows(first):
        lines.append(f"  {'every link' if ee == COMMON else ee}")
        for index, step in enumerate(steps):
            shares = " ".join(f"{_share(each, ee, index):.3f}" for each in values)
            purpose = f" to {step.purpose}" if step.purpose else ""
            call = f"{step.action}({', '.join(step.objects)}){purpose}"
            lines.append(f"    {index + 1}. {call:<48} {shares}")
    for relation in first.relations:
        (one, i), (two, j) = relation.first, relation.second
        lines.append(f"  {one} {i + 1} {relation.relation} {two} {j + 1}")
    lines.append("  observed, in the order of the shares:")
    lines += [
        f"    {each.name} by {_performers(store, each)}, {each.duration_s:.3f} s, "
        f"profile {each.profile}"
        for each in found
    ]
    return "\n".join(lines) + "\n"


def _performers(store: Store, observed: Stored) -> str:
    """Everyone who acts in an observation, its first agent first."""
    acting = {each.agent for each in stored_pars.ipars(store, observed.name)} or {observed.agent}
    return " and ".join(sorted(acting, key=lambda name: (name != observed.agent, name)))


def _rows(value: ComplexPar) -> Iterable[tuple[str, tuple[Step, ...]]]:
    for link in value.links:
        yield link.ee, link.steps
    if value.common:
        yield COMMON, (value.common,)


def _share(value: ComplexPar, ee: str, index: int) -> float:
    steps = dict(_rows(value)).get(ee, ())
    return steps[index].share if index < len(steps) else 0.0


def as_svg(store: Store, name: str) -> str:
    """The action's steps as bars over its duration, a row a link."""
    value = stored_pars.complex_par(store, seen(store, name)[0].name)
    actions = sorted({step.action for _, steps in _rows(value) for step in steps})
    colour = {each: COLOURS[index % len(COLOURS)] for index, each in enumerate(actions)}
    links = [ee for ee, _ in _rows(value) if ee != COMMON]
    height = TOP + ROW * len(links) + 30
    title = f"{value.name}, {value.duration_s:.2f} s"
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
        f'viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" font-size="12" role="img">',
        f"<title>{escape(title)}</title>",
        svg.text(LEFT, 22, title, font_size=15),
    ]
    for row, ee in enumerate(links):
        y = TOP + ROW * row
        lines.append(svg.text(8, y + 22, ee))
    for ee, steps in _rows(value):
        row, rows = (0, len(links)) if ee == COMMON else (links.index(ee), 1)
        for step in steps:
            lines += _bar(step, TOP + ROW * row, ROW * rows - 8, colour[step.action])
    return "\n".join([*lines, "</svg>"]) + "\n"


def _bar(step: Step, y: int, height: int, colour: str) -> list[str]:
    span = WIDTH - LEFT - 10
    x, width = LEFT + span * step.begin, max(span * step.share, 1.0)
    text = f"{step.action}({', '.join(step.objects)})"
    about = f"{text}: {step.share:.3f} of the whole" + (
        f", to {step.purpose}" if step.purpose else ""
    )
    box = svg.rect(f"{x:.1f}", y, f"{width:.1f}", height, radius=3, fill=colour, stroke="white")
    label = svg.text(4, f"{height / 2 + 4:.1f}", text, fill="white")
    return [
        f"<g><title>{escape(about)}</title>{box}",
        f'<svg x="{x:.1f}" y="{y}" width="{width:.1f}" height="{height}">{label}</svg></g>',
    ]


def as_turtle(store: Store, name: str) -> str:
    """The complex action, and its steps as each observation saw them."""
    triples = []
    for use in seen(store, name):
        about = names.observation(use.name)
        quads = part(store, use.name)
        whole = {q.object for q in quads if q.subject == about and q.predicate == CAPAR.enacts}
        steps = {q.object for q in quads if q.predicate in {CAPAR.step, CAPAR.complexStep}}
        subjects = whole | steps
        keep = {CAPAR.enacts, CAPAR.step, CAPAR.name, CAPAR.agent, CAPAR.duration, CAPAR.objects}
        triples += [
            q.triple
            for q in quads
            if (isinstance(q.subject, NamedNode) and q.subject in subjects)
            or (q.subject == about and q.predicate in keep)
        ]
    unique = sorted(dict.fromkeys(triples), key=str)
    return turtle(unique, form=RdfFormat.TURTLE)


FORMATS = {"text": as_text, "svg": as_svg, "turtle": as_turtle}
"""How an action may be drawn."""
