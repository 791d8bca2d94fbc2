"""Facts in, atoms out: rules grounded and solved by clingo, in slices and within limits."""

import json
import os
import re
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache, wraps
from hashlib import sha256
from importlib import resources
from itertools import chain, islice
from pathlib import Path
from tempfile import NamedTemporaryFile
from time import monotonic
from typing import Any, ParamSpec, TypeVar, cast

import clingo

from capar.model.capture import NAME
from capar.model.errors import NoAnswerError, RuleError
from capar.model.facts import Fact, program, signatures
from capar_rules.engine import syntax
from capar_rules.engine.syntax import Signature, asked_for, fired, heads_of, needed, parse

Row = tuple[str, list[str], list[str]]
"""A rule or directive: its text, and the predicates that it defines and needs, as name/arity."""


def reduced(files: Iterable[Path]) -> list[Row]:
    """Every directive of rule files, and the rules on which what is shown depends."""
    statements = asked_for([each for each in parse(files) if each.kind != "comment"])
    return [
        (each.text, sorted(map(_slashed, heads_of([each]))), sorted(map(_slashed, needed(each))))
        for each in statements
    ]


def _slashed(signature: Signature) -> str:
    return f"{signature[0]}/{signature[1]}"


REDUCED = "engine/reduced.json"
"""The shipped rules, reduced: rows by the fingerprint of their files."""


MOST_KEPT = 64
"""How many reduced rule bases of users are kept, the latest ones [1]."""


@cache
def _shipped() -> dict[str, list[Row]]:
    path = rule_file(REDUCED)
    found: dict[str, list[Row]] = json.loads(path.read_bytes()) if path.is_file() else {}
    return found


def store_reduced(bases: Iterable[tuple[Path, ...]]) -> None:
    """Reduce these rule bases, and store them beside the rules, a rule a line."""
    found = {fingerprint(files): reduced(files) for files in bases}
    text = json.dumps(found).replace('], ["', '],\n["')
    rule_file(REDUCED).write_text(text + "\n", encoding="utf-8")


def _kept(files: tuple[Path, ...], measured: Iterable[Signature]) -> list[Row]:
    """A rule base reduced: as it is shipped, or kept since it was first asked of such predicates.

    Raises:
        RuleError: The solver has a remark on rules that are not kept.
    """
    mark = fingerprint(files)
    if mark in _shipped():
        return _shipped()[mark]
    way = sha256(Path(syntax.__file__).read_bytes()).hexdigest()
    place = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "capar" / "rules"
    path = place / f"{mark}-{way[:8]}.json"
    with suppress(OSError, ValueError):
        if kept := json.loads(path.read_bytes()):
            return cast(list[Row], kept)
    defined = "".join(f"#defined {name}/{arity}.\n" for name, arity in sorted(measured))
    _grounded(files, defined, "--models=1")
    rows = reduced(files)
    with suppress(OSError):  # They are reduced again by the next process.
        place.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile("w", dir=place, delete=False, encoding="utf-8") as file:
            json.dump(rows, file)
        Path(file.name).replace(path)
        for old in sorted(place.iterdir(), key=lambda each: each.stat().st_mtime)[:-MOST_KEPT]:
            old.unlink()
    return rows


class RuleBase:
    """Rule files that are asked again and again."""

    def __init__(self, files: Iterable[Path]) -> None:
        self.files = tuple(files)
        self.programs: dict[frozenset[Signature], str] = {}
        """What remains of the rules for facts of these predicates."""
        self.rows: list[Row] = []
        """Those on which an answer depends, once they were asked [1]."""

    def program(self, measured: frozenset[Signature]) -> str:
        """Every directive, and the rules on which the answer depends.

        ``measured``: the only predicates that have facts.
        """
        if measured not in self.programs:
            self.rows = self.rows or _kept(self.files, measured)
            numbers = fired([row[1:] for row in self.rows], map(_slashed, measured))
            self.programs[measured] = "\n".join(self.rows[number][0] for number in numbers)
        return self.programs[measured]


BLOCK_FACTS = 4096
"""How many facts are given to the solver as one text [1]."""

Term = int | str | tuple["Term", ...]
"""A value of the rules: a number, a name or text, or a compound as (functor, arguments...)."""


_Asked = ParamSpec("_Asked")
_Found = TypeVar("_Found")


@dataclass(frozen=True)
class Answer:
    """The one answer of a program: its shown atoms."""

    atoms: tuple[tuple[str, tuple[Term, ...]], ...]
    """Predicate and arguments, sorted."""

    @cached_property
    def _by_name(self) -> dict[str, list[tuple[Term, ...]]]:
        table: dict[str, list[tuple[Term, ...]]] = {}
        for name, arguments in self.atoms:
            table.setdefault(name, []).append(arguments)
        return table

    def of(self, predicate: str) -> Sequence[tuple[Term, ...]]:
        """Arguments of every shown atom of a predicate, sorted."""
        return self._by_name.get(predicate, [])


def rule_file(name: str) -> Path:
    """The path of a rule file that ships with this package."""
    return Path(str(resources.files("capar_rules") / name))


def solve(files: Iterable[Path], facts: str | Iterable[Fact] = "") -> Answer:
    """The one answer of the rule files over the facts.

    Raises:
        NoAnswerError: There is none.
        RuleError: The solver has a remark of any kind, or there is more than one.
    """
    answers = _answers(files, facts, "--models=2")
    if len(answers) > 1:
        first, second = (set(answer.atoms) for answer in answers)
        name, arguments = sorted(first ^ second, key=str)[0]
        raise RuleError(
            "the rules have more than one answer over these facts; they differ first in "
            f"{name}{arguments}: rules may not choose"
        )
    return answers[0]


def best(files: Iterable[Path], facts: str | Iterable[Fact] = "") -> Answer:
    """The best answer of rule files that choose and weigh, as their weak constraints have it.

    Rules that weigh say themselves which of equals is better; should equals remain, the solver,
    one thread without chance over facts in their order, takes the same one each time.

    Raises:
        NoAnswerError: There is none.
        RuleError: The solver has a remark of any kind.
    """
    return _answers(files, facts, "--opt-strategy=usc,stratify")[-1]


def _answers(files: Iterable[Path], facts: str | Iterable[Fact], option: str) -> list[Answer]:
    files, facts = tuple(files), facts if isinstance(facts, str) else tuple(facts)
    found: list[Answer] = []
    _grounded(files, facts, option).solve(on_model=lambda model: found.append(_shown(model)))
    if not found:
        raise NoAnswerError(files, facts)
    return found


def asking(function: Callable[_Asked, _Found]) -> Callable[_Asked, _Found]:
    """A function of what was measured, whose ``NoAnswerError`` can be asked about less of it."""

    @wraps(function)
    def asked(*given: _Asked.args, **options: _Asked.kwargs) -> _Found:
        try:
            return function(*given, **options)
        except NoAnswerError as error:
            error.measured = cast(Any, given[0])
            error.ask = lambda facts: cast(Any, function)(facts, **options)
            raise

    return asked


def least_contradiction(
    error: NoAnswerError, *, within_s: float = 20.0
) -> tuple[tuple[Path, ...], tuple[Fact, ...]]:
    """The rule files at fault, and the fewest measured facts found without an answer.

    Shipped rules are at fault if they have no answer by themselves, else files of the user.
    ``within_s``: how long facts are left out: halves, quarters and so on, in order of time [s].
    """
    end = monotonic() + within_s
    facts = sorted(error.measured, key=lambda fact: (*fact.ends(), -1)[0])
    size, last = len(facts) // 2, error
    while size and monotonic() < end:
        before, at = len(facts), 0
        while at < len(facts) and monotonic() < end:
            fewer = facts[:at] + facts[at + size :]
            try:
                error.ask(fewer)
            except NoAnswerError as again:
                facts, last = fewer, again
                continue
            except (RuleError, LookupError, ValueError, StopIteration):
                pass  # without these facts nothing can be asked
            at += size
        size = size // 2 or int(len(facts) < before)
    shipped = tuple(file for file in last.files if file.is_relative_to(rule_file("")))
    added = tuple(file for file in last.files if file not in shipped)
    if not added or not _has_answer(shipped, last.facts):
        return shipped[:1], tuple(facts)
    alone = (each for each in added if not _has_answer((*shipped, each), last.facts))
    return tuple(alone) or added, tuple(facts)


def _has_answer(files: Iterable[Path], facts: Iterable[Fact]) -> bool:
    try:
        solve(files, facts)
    except NoAnswerError:
        return False
    return True


def _texts(facts: Iterable[Fact]) -> Iterator[str]:
    """The facts as programs of so many at a time: one text of them all takes more than they do."""
    waiting = iter(facts)
    while block := tuple(islice(waiting, BLOCK_FACTS)):
        yield program(block)


def text_of(term: Term) -> str:
    """A value as it stands in a program; text that is no name is quoted."""
    if isinstance(term, tuple):
        functor, *arguments = term
        return f"{functor}({','.join(map(text_of, arguments))})"
    if isinstance(term, int) or NAME.fullmatch(term):
        return str(term)
    return str(clingo.String(term))


def fingerprint(files: Iterable[Path]) -> str:
    """SHA-256 over the rule files and all that they include, in the order of their names."""
    contents = _contents(files)
    digest = sha256()
    for path in sorted(contents, key=lambda path: (path.name, contents[path])):
        digest.update(path.name.encode() + b"\0" + contents[path] + b"\0")
    return digest.hexdigest()


def loaded_files(files: Iterable[Path]) -> tuple[Path, ...]:
    """The rule files and all that they include, sorted."""
    return tuple(sorted(_contents(files)))


def _contents(files: Iterable[Path]) -> dict[Path, bytes]:
    seen: dict[Path, bytes] = {}
    waiting = [Path(each).resolve() for each in files]
    while waiting:
        path = waiting.pop()
        if path not in seen:
            about = path.stat()
            seen[path], included = _read(path, about.st_mtime_ns, about.st_size)
            waiting += included
    return seen


_INCLUDE = re.compile(r'^[ \t]*#include [^"\n]*"([^"\n]*)"', re.MULTILINE)


@lru_cache(maxsize=512)
def _read(path: Path, changed_ns: int, size: int) -> tuple[bytes, tuple[Path, ...]]:
    """What a file holds that was changed then, and the files that it includes."""
    content = path.read_bytes()
    return content, tuple(path.parent / name for name in _INCLUDE.findall(content.decode()))


def _grounded(files: Iterable[Path], facts: str | Iterable[Fact], option: str) -> clingo.Control:
    messages: list[str] = []

    def note(_: clingo.MessageCode, message: str) -> None:
        messages.append(message.strip())

    facts = facts if isinstance(facts, str) else tuple(facts)
    loaded, texts = _program(tuple(files), facts)
    # Every rule file includes what it reads, so that a file is named twice is no fault.
    options = [option, "--warn=no-file-included"]
    if not loaded:
        # What rules without an instance would define is undefined where they are left out.
        options.append("--warn=no-atom-undefined")
    control = clingo.Control(options, logger=note, message_limit=100)
    try:
        for path in loaded:
            control.load(str(path))
        for text in texts:
            control.add("base", [], text)
        control.ground([("base", [])])
    except RuntimeError as error:
        messages = messages or [str(error)]
    if messages and not loaded and not isinstance(facts, str):
        return _grounded(files, program(facts), option)  # which says where in the files
    if messages:
        raise RuleError("\n".join(messages))
    return control


def _program(
    files: tuple[Path, ...], facts: str | tuple[Fact, ...]
) -> tuple[tuple[Path, ...], Iterator[str]]:
    """Files to load, and texts to add: those of the rules reduced, but where facts are a text."""
    if isinstance(facts, str):
        return files, iter([facts])
    base = _rule_base(files, tuple(_contents(files).values()))
    return (), chain([base.program(signatures(facts))], _texts(facts))


@lru_cache(maxsize=16)
def _rule_base(files: tuple[Path, ...], state: tuple[bytes, ...]) -> RuleBase:
    """The rules of files while these hold what they do."""
    return RuleBase(files)


def _shown(model: clingo.Model) -> Answer:
    symbols = sorted(model.symbols(shown=True))
    return Answer(tuple((each.name, tuple(map(as_term, each.arguments))) for each in symbols))


@lru_cache(maxsize=1 << 14)
def as_term(symbol: clingo.Symbol) -> Term:
    """A symbol of the solver as a plain value; answers name the same segments again and again."""
    if symbol.type is clingo.SymbolType.Number:
        return symbol.number
    if symbol.type is clingo.SymbolType.String:
        return symbol.string
    if symbol.arguments:
        return (symbol.name, *map(as_term, symbol.arguments))
    return symbol.name


Atom = tuple[str, tuple[Term, ...]]
"""Predicate and arguments."""

ERRORS_ONLY = "--warn=none"
"""Remarks on predicates without a rule mean nothing where only a part of the rules is solved."""


def worlds(text: str) -> list[tuple[str, ...]]:
    """The shown atoms of every answer, each as a fact's text; answers in order.

    Raises:
        RuleError: The program has an error.
    """
    control = _grounded_text(text, ["--models=0", "--project=show"])
    found: list[tuple[str, ...]] = []
    control.solve(on_model=lambda model: found.append(tuple(map(str, model.symbols(shown=True)))))
    return sorted(tuple(sorted(each)) for each in found)


def understand(text: str) -> None:
    """Have the solver read a program and check its safety without grounding anything.

    Raises:
        RuleError: The program has an error, such as an unsafe variable.
    """
    _grounded_text(text, (), part="nothing")


def _grounded_text(text: str, options: Sequence[str], *, part: str = "base") -> clingo.Control:
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

    ``shown``: their predicates.

    Raises:
        RuleError: The program has an error, or no answer.
    """
    predicates = tuple(shown)
    shows = "".join(f"#show {name}/{arity}.\n" for name, arity in sorted(predicates))
    options = ["--enum-mode=brave", "--models=0"]
    control = _grounded_text(f"{text}\n{shows or '#show.'}\n", options)
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
        return frozenset(map(_atom, last.symbols(shown=True)))


def _atom(symbol: clingo.Symbol) -> Atom:
    return symbol.name, tuple(map(as_term, symbol.arguments))
