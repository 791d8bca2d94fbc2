"""The version of the JSON form of an observation, and bringing older documents to it.

Version 1 stated no version, could hold facts that are no longer measured, had notices of a code
and a sentence alone, and no calibration. Version 2 had no tracks and no naming rules.
"""

import json
from typing import Any

from capar.model.errors import ParError
from capar.model.facts import ALL_FACT_KINDS

SCHEMA = 3
"""The version that this program reads and writes, the field ``schema`` of an observation."""


def version(text: str, *, where: str = "") -> int:
    """The version of the observation that a JSON text states.

    Raises:
        ParError: The text is no JSON object, or its version is no number from 1.
    """
    return _version(_document(text, where), where)


def take_schema(content: dict[str, Any], where: str) -> None:
    """Take the version out of an observation's document.

    Raises:
        ParError: It is another one than this program's; the message says what to do.
    """
    if "schema" not in content and "links" not in content:
        raise ParError(f"{_place(where)}expected an observation, found none of its fields")
    found = _version(content, where)
    if found < SCHEMA:
        raise ParError(
            f"{_place(where)}this is an observation of schema {found}, this program reads "
            f"{SCHEMA}; run: capar migrate {where or 'FILE'}"
        )
    if found > SCHEMA:
        raise ParError(
            f"{_place(where)}a newer program wrote this observation (schema {found}; this one "
            f"reads {SCHEMA}); install a capar that reads it, or observe the capture again"
        )
    del content["schema"]


def migrated(text: str, *, where: str = "") -> str:
    """An observation's JSON text, brought from its older version to this one.

    Raises:
        ParError: It is no JSON object, or its version is no number from 1.
    """
    content = _document(text, where)
    found = _version(content, where)
    if found < SCHEMA:
        content = _of_present_kinds(_from_1(content) if found == 1 else content)
    return json.dumps(content)


def _of_present_kinds(content: dict[str, Any]) -> dict[str, Any]:
    """The same in the present version, without facts that are no longer measured."""
    known = {each.predicate for each in ALL_FACT_KINDS}
    facts = content.get("facts", [])
    kept = [each for each in facts if str(each).partition("(")[0] in known]
    return {**content, "schema": SCHEMA, "facts": kept}


def _from_1(content: dict[str, Any]) -> dict[str, Any]:
    """The same with notices as version 2 has them."""
    return {**content, "notices": [_sentence_only(each) for each in content.get("notices", [])]}


def _sentence_only(notice: Any) -> Any:
    """A notice of version 1, which had a code and a sentence, kept in its own words."""
    if not isinstance(notice, dict) or "bodies" in notice:
        return notice
    values = {"was": notice.get("code"), "text": notice.get("message")}
    return {"code": "earlier", "bodies": [], "values": values}


def _document(text: str, where: str) -> dict[str, Any]:
    try:
        content = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ParError(f"{_place(where)}this is no JSON: {error}") from None
    if not isinstance(content, dict):
        raise ParError(f"{_place(where)}expected an observation, found no object in braces")
    return content


def _version(content: dict[str, Any], where: str) -> int:
    found = content.get("schema", 1)
    if type(found) is not int or found < 1:
        raise ParError(f"{_place(where)}schema: expected a whole number from 1, found {found!r}")
    return found


def _place(where: str) -> str:
    return f"{where}: " if where else ""
