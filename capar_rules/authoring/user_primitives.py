"""Rules that people write: new ones from what was seen, trying, adding and removing them."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from capar.model.errors import FileError, RuleError, UnknownNameError
from capar.model.facts import (
    Fact,
    ForceTransfer,
    Frames,
    Gap,
    Link,
    Moving,
    RateMhz,
    Tag,
    Touching,
    ZeroCrossing,
)
from capar.model.par import FeatureSet
from capar_rules.authoring.catalogue import RuleInfo as RuleInfo
from capar_rules.authoring.catalogue import dependants
from capar_rules.authoring.catalogue import introduced as introduced
from capar_rules.authoring.catalogue import rule_of as rule_of
from capar_rules.authoring.catalogue import rules_of as rules_of
from capar_rules.authoring.examples import Example, lacking, read_examples, try_examples, written
from capar_rules.authoring.user_rules import make_folder, taught
from capar_rules.authoring.user_rules import user_rules as user_rules
from capar_rules.engine.profiles import DEFAULT, profile
from capar_rules.engine.syntax import parse, parse_text
from capar_rules.lint.admission import admitted_profile
from capar_rules.lint.checking import check, require
from capar_rules.lint.findings import errors
from capar_rules.lint.name_checks import rivals
from capar_rules.lint.text_checks import known

TELLING = (Frames, RateMhz, Link, Tag, ZeroCrossing, Touching, Gap, Moving, ForceTransfer)
"""The facts that an example contains: contacts and motions, without places and courses."""


def new_rule(
    name: str,
    features: FeatureSet,
    *,
    definition: str = "",
    general: str | Sequence[str] = (),
    besides: Sequence[str] = (),
    verb: str = "",
    rule: str = "",
    examples: Sequence[Example] = (),
) -> str:
    """The text of a rule file for a primitive with these features.

    Args:
        name: What it is called.
        features: The feature set that a segment has.
        definition: What it is, in words.
        general: The primitives that it specialises.
        besides: Others that fit some of the same segments, over which it takes precedence.
        verb: The verb for it; its name in small letters if empty.
        rule: Which segments fit it, in place of the row of features.
        examples: Examples and counter-examples.

    Raises:
        RuleError: The name is no name of a primitive, or a text would not stay a text.
    """
    said = " ".join((definition or "named by a user for this feature set").split())
    if "%*" in said or "*%" in said or set(verb) & set('"\\\n'):
        raise RuleError("a definition holds no *% and a verb no quotes; write plain words")
    _, *lines = taught(name, features, verb=verb).splitlines(keepends=True)
    over = [general] if isinstance(general, str) else general
    kept = [each for each in lines if not (rule and each.startswith("feature_row("))]
    text = f"%* {name}: {said.rstrip('.')}. *%\n{''.join(kept)}"
    text += "".join(f'specialises("{name}", "{each}").\n' for each in over if each)
    if besides:
        text += "% These name segments with the same features: it takes precedence over them.\n"
        text += "".join(f'precedes("{name}", "{each}").\n' for each in besides)
    text += rule or (
        "% The row fits every segment with these features. To fit fewer, put a rule in its place:\n"
        f'%   fits(Segment, "{name}") :- fits(Segment, "{next(iter(over), "") or "General"}"), '
        "further conditions.\n"
    )
    if not examples:
        text += LACKING
    return "\n".join([text, *map(written, examples)])


LACKING = "% Before it can be added it needs an Example and a Counter-example.\n"


def telling(facts: Sequence[Fact]) -> tuple[Fact, ...]:
    """The facts of a capture that an example contains."""
    return tuple(each for each in facts if isinstance(each, TELLING))


def try_rule(path: Path, *, base: str = DEFAULT, beside: Sequence[Path] = ()) -> tuple[str, ...]:
    """A message for each example whose names are not inferred; empty if all hold.

    Raises:
        RuleError: An example cannot be read, or the rules have an error.
    """
    examples = read_examples(_text(path), file=path)
    names = introduced(path)
    failures = []
    rules = admitted_profile(base, added=(*(each for each in beside if each != path), path))
    for outcome in try_examples(examples, profile=rules):
        if not outcome.met:
            found = dict(outcome.found)
            for ee, expected in outcome.example.names:
                if found.get(ee) != expected:
                    failures.append(
                        f"{path}:{outcome.example.line}: {outcome.example.story!r} expects "
                        f"{ee}: {', '.join(expected)}; found {', '.join(found.get(ee, ()))}"
                    )
    return (
        *failures,
        *(f"{path}: it lacks {each}" for name in names for each in lacking(examples, name)),
    )


def add_rule(
    path: Path,
    *,
    folder: Path,
    base: str = DEFAULT,
    over: Sequence[str] = (),
    kind_of: Sequence[str] = (),
    beside: Sequence[Path] | None = None,
) -> Path:
    """Add a rule file to the user's rules, if its check finds no error and its examples hold.

    Args:
        path: The file.
        folder: The folder of rules to which it is copied.
        base: The profile that it joins.
        over: Primitives that it is to precede, which resolves ambiguities; ``all`` stands for each
            that names a segment with it, or may do so.
        kind_of: Primitives that it is to specialise.
        beside: Every rule file loaded already; None for those of the folder.

    Returns:
        Where it now is.

    Raises:
        RuleError: The check finds errors, an ambiguity among them, or an example fails.
        FileError: A file of that name is there already.
    """
    with checked_draft(
        path, folder=folder, base=base, over=over, kind_of=kind_of, beside=beside
    ) as draft:
        return draft.replace(folder / path.name)


@contextmanager
def checked_draft(
    path: Path,
    *,
    folder: Path,
    base: str = DEFAULT,
    over: Sequence[str] = (),
    kind_of: Sequence[str] = (),
    beside: Sequence[Path] | None = None,
) -> Iterator[Path]:
    """The same up to the last step: a checked copy that only needs to be moved into the folder.

    Raises:
        RuleError: The check finds errors, an ambiguity among them, or an example fails.
        FileError: A file of that name is there already.
    """
    target = folder / path.name
    if target.exists():
        raise FileError(target, "exists already.", "Remove that rule first, or rename this file.")
    make_folder(folder)
    others = user_rules(folder) if beside is None else tuple(beside)
    others = tuple(each for each in others if each.resolve() != path.resolve())
    with TemporaryDirectory(dir=folder, prefix=".draft") as place:
        draft = Path(place) / path.name
        draft.write_text(_text(path), encoding="utf-8")
        if over or kind_of:
            ordering = _ordering(draft, over, kind_of, base=base, beside=others)
            draft.write_text(_text(path) + ordering, encoding="utf-8")
        findings = check(draft, profile=base, beside=others)
        require(
            path,
            [
                replace(each, place=replace(each.place, file=str(path)))
                if each.place.file == str(draft)
                else each
                for each in findings
            ],
        )
        try:
            failures = try_rule(draft, base=base, beside=others)
        except RuleError as error:
            raise RuleError(str(error).replace(str(draft), str(path))) from None
        if failures:
            told = "\n".join(failures).replace(str(draft), str(path))
            raise RuleError(f"its examples do not hold:\n{told}")
        yield draft


def removable(name: str, *, files: Sequence[Path], every: Sequence[Path] = ()) -> Path:
    """The rule file that introduces a primitive, if it can be removed.

    Args:
        name: The primitive.
        files: The files to search; the first that introduces it is returned.
        every: All rule files that are loaded together, some of which may depend on it.

    Raises:
        UnknownNameError: None of the files introduces it.
        RuleError: Another rule depends on it.
    """
    info = {each: path for path in reversed(files) for each in introduced(path)}
    if name not in info:
        folders = ", ".join(sorted({str(each.parent) for each in files}))
        raise UnknownNameError("rule of the user's", name, info, where=folders)
    path = info[name]
    resting = dependants(path, files=every)
    if resting:
        told = ", ".join(f"{each} ({file})" for each, file in sorted(resting.items()))
        raise RuleError(
            f"{path} stays: {told} rests on {', '.join(introduced(path))}. Remove that first, or "
            "have it specialise another primitive."
        )
    return path


ALL = "all"
"""Stands for every primitive that names a segment together with a new one."""


def _ordering(
    path: Path, over: Sequence[str], kind_of: Sequence[str], *, base: str, beside: Sequence[Path]
) -> str:
    """The facts that put the primitives of a file before others, or make them kinds of those."""
    lines = []
    for name in introduced(path):
        stated = [f'specialises("{name}", "{other}").' for other in kind_of]
        stated += [f'precedes("{name}", "{other}").' for other in over if other != ALL]
        lines += stated
        if ALL in over:
            found = beaten(path, name, base=base, beside=beside, stated=stated)
            lines += [f'precedes("{name}", "{other}").' for other in found]
    return "".join(f"{each}\n" for each in lines)


def beaten(
    path: Path, name: str, *, base: str, beside: Sequence[Path], stated: Sequence[str] = ()
) -> tuple[str, ...]:
    """The primitives that name a segment with one of a file, or may; nothing if it has errors.

    Args:
        path: The rule file.
        name: The primitive.
        base: The profile that it joins.
        beside: The user's other rule files.
        stated: What it specialises or precedes beside what the file states, as facts.
    """
    found = errors(check(path, profile=base, beside=beside))
    if any(each.code != "ambiguous" for each in found):
        return ()
    own = [*parse([path]), *parse_text("\n".join(stated))]
    return rivals(name, own, known(parse(profile(base).files)), parse(beside) if beside else ())


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror}.", "Name a rule file.") from None
    except UnicodeDecodeError:
        raise FileError(path, "is no UTF-8 text.", "Save it as UTF-8.") from None
