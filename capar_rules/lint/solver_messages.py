"""What the solver itself reports of a rule file: syntax, unsafe variables, what it refuses."""

import re
from collections.abc import Iterator

from capar.model.errors import RuleError
from capar_rules.engine.search import brave, understand
from capar_rules.engine.syntax import Place
from capar_rules.lint.findings import Finding

_MESSAGE = re.compile(r"[^:\n]*:(\d+):(\d+)(?:-[\d:]+)?: (?:error|info): (.*)")
_UNSAFE = re.compile(r": note: '(\w+)' is unsafe")


def safety_findings(text: str, file: str) -> Iterator[Finding]:
    """What the solver reports when it grounds a file by itself."""
    try:
        brave(text, ())
    except RuleError as error:
        yield from solver_findings(str(error), file)


def unsafe_findings(text: str, file: str) -> Iterator[Finding]:
    """What the solver reports when it only reads a file: unsafe variables above all."""
    try:
        understand(text)
    except RuleError as error:
        yield from solver_findings(str(error), file)


def solver_findings(message: str, file: str) -> Iterator[Finding]:
    """The solver's messages as findings."""
    variables = _UNSAFE.findall(message)
    found = False
    for line in message.splitlines():
        match = _MESSAGE.match(line)
        if match is None:
            continue
        found = True
        place = Place(file, int(match[1]), int(match[2]))
        if "unsafe" in match[3]:
            names = ", ".join(dict.fromkeys(variables)) or "a variable"
            yield Finding(
                place, "unsafe-variable", f"nothing says which values {names} may take.",
                "Name it in a condition without not, such as segment(Segment, From, To).",
            )  # fmt: skip
        elif "syntax error" in match[3] or "lexer error" in match[3]:
            wrong = match[3].split("error, ")[-1]
            yield Finding(
                place, "syntax", f"this is no rule: {wrong}.",
                "A rule reads head :- condition, condition. and ends with a full stop.",
            )  # fmt: skip
        else:
            yield Finding(place, "refused", f"the solver refuses it: {match[3]}.", "Rewrite it.")
    if not found:
        yield Finding(
            Place(file, 1, 1), "refused", f"the solver refuses it: {message.strip()[:200]}.",
            "Rewrite it.",
        )  # fmt: skip
