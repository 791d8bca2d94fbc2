"""Questions that a check puts to the solver: whether rules fire, and who names a segment."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Atom, Signature, Statement, parse_text, split_arguments
from capar_rules.lint.candidates import ROW
from capar_rules.lint.word_places import STRING

FIRED, IDLE, HELD, ROW_HELD = ("_fired", 1), ("_idle", 1), ("_held", 3), ("_row", 1)

_COMPUTES = re.compile(r"[-+*/\\|&?^~;]|\.\.")
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')


def firing_probes(rules: Mapping[int, Statement]) -> Iterator[Statement]:
    """Whether each rule fires in some segment, and whether a rule of fits does not in some."""
    for number, rule in rules.items():
        head = rule.heads[0]
        if rule.body:
            body = "; ".join(each.text for each in rule.body)
            text = f"_fired({number}) :- {body}.\n"
            if head.signature == FITS:
                segment = split_arguments(head.text)[0]
                text += f"_fired({number},{segment}) :- {body}.\n"
                text += f"_idle({number}) :- segment(S,_,_); not _fired({number},S).\n"
            yield from parse_text(text)
        elif head.signature == ROW:
            features = ",".join(split_arguments(head.text)[2:])
            yield from parse_text(f"_row({number}) :- features(_,{features}).\n")


def holding_probes(conditions: Mapping[tuple[int, int], Atom]) -> Iterator[Statement]:
    """Whether conditions, each by its rule and index, hold anywhere, and their relations at all."""
    for (number, place), atom in conditions.items():
        name, arity = atom.signature
        text = f"_held({number},{place},so) :- {_loosened(atom.text)}.\n"
        if arity:
            text += f"_held({number},{place},any) :- {name}({','.join('_' * arity)}).\n"
        yield from parse_text(text)


def plain_conditions(rule: Statement) -> Iterator[tuple[int, Atom]]:
    """The positive conditions of a rule without arithmetic, each with its index."""
    for place, literal in enumerate(rule.body):
        if literal.kind == "atom" and literal.sign == 0:
            atom = literal.atoms[0]
            if not _COMPUTES.search(STRING.sub("", atom.text)):
                yield place, atom


def _loosened(text: str) -> str:
    """An atom's text with its variables anonymous."""
    return _TOKEN.sub(lambda found: found[0] if found[0].startswith('"') else "_", text)


def naming_probes(names: Iterable[str], watched: Iterable[str]) -> Sequence[Statement]:
    """Whether primitives fit, which others name a segment with them, and which ever name one."""
    text = ""
    for name in names:
        text += f'_fitted("{name}") :- fits(_,"{name}").\n'
        text += f'_rival("{name}",Other) :- named(S,"{name}"), named(S,Other), Other != "{name}".\n'
    text += "".join(f'_wins("{name}") :- named(_,"{name}").\n' for name in watched)
    return parse_text(text)


FITTED, RIVAL, WINS = ("_fitted", 1), ("_rival", 2), ("_wins", 1)

ASKED: tuple[Signature, ...] = (FIRED, IDLE, ROW_HELD, FITTED, RIVAL, WINS)
"""What a check asks of each world: few atoms, as the search takes longer for each that is asked."""
