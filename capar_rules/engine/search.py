"""Programs with several answers: all of them, their union, and the optimal ones."""

from collections.abc import Container, Iterable, Sequence

import clingo

from capar.model.errors import RuleError
from capar_rules.engine.solver import Term, as_term
from capar_rules.engine.syntax import Signature

Atom = tuple[str, tuple[Term, ...]]
"""Predicate and arguments."""

ERRORS_ONLY = "--warn=none"
"""Remarks on predicates without a rule mean nothing where only a part of the rules is solved."""


def worlds(text: str) -> list[tuple[str, ...]]:
    """The shown atoms of every answer, each as a fact's text; answers in order.

    Raises:
        RuleError: The program has an error.
    """
    control = _grounded(text, ["--models=0", "--project=show"])
    found: list[tuple[str, ...]] = []
    control.solve(on_model=lambda model: found.append(tuple(map(str, model.symbols(shown=True)))))
    return sorted(tuple(sorted(each)) for each in found)


def optima(text: str, shown: Iterable[Signature], *, limit: int = 1) -> list[frozenset[Atom]]:
    """The shown atoms of each optimal answer, without duplicates; none if there is no answer.

    Raises:
        RuleError: The program has an error.
    """
    control = _grounded(
        _showing(text, shown), ["--opt-mode=optN", "--project=show", f"--models={limit + 1}"]
    )
    found: list[frozenset[Atom]] = []
    with control.solve(yield_=True) as handle:
        for model in handle:
            if model.optimality_proven:
                found.append(_atoms(model))
                if len(found) == limit:
                    break
    return sorted(set(found), key=lambda each: sorted(map(str, each)))


def understand(text: str) -> None:
    """Have the solver read a program and check its safety without grounding anything.

    Raises:
        RuleError: The program has an error, such as an unsafe variable.
    """
    _grounded(text, (), part="nothing")


def _grounded(text: str, options: Sequence[str], *, part: str = "base") -> clingo.Control:
    messages: list[str] = []

    def note(_: clingo.MessageCode, message: str) -> None:
        messages.append(message.strip())

    control = clingo.Control([ERRORS_ONLY, *options], logger=note)
    try:
        control.add("base", [], text)
        control.ground([(part, [])])
    except RuntimeError as error:
        raise RuleError("\n".join(messages) or str(error)) from None
    return control


def brave(text: str, shown: Iterable[Signature], *, known: Container[Atom] = ()) -> frozenset[Atom]:
    """The atoms that are shown in at least one answer of a program.

    Args:
        text: The program.
        shown: Their predicates.
        known: Atoms that need not be found; the program is not solved if it has no others.

    Raises:
        RuleError: The program has an error, or no answer.
    """
    predicates = tuple(shown)
    control = _grounded(_showing(text, predicates), ["--enum-mode=brave", "--models=0"])
    possible = (
        atom.symbol
        for signature in predicates
        for atom in control.symbolic_atoms.by_signature(*signature)
    )
    if all(_atom(symbol) in known for symbol in possible):
        return frozenset()
    with control.solve(yield_=True) as handle:
        for _ in handle:
            pass  # each model contains the atoms of those before
        last = handle.last()
        if last is None:
            raise RuleError("these rules contradict each other: they have no answer")
        return _atoms(last)


def _showing(text: str, shown: Iterable[Signature]) -> str:
    shows = "".join(f"#show {name}/{arity}.\n" for name, arity in sorted(shown))
    return f"{text}\n{shows or '#show.'}\n"


def _atoms(model: clingo.Model) -> frozenset[Atom]:
    return frozenset(map(_atom, model.symbols(shown=True)))


def _atom(symbol: clingo.Symbol) -> Atom:
    return symbol.name, tuple(map(as_term, symbol.arguments))
