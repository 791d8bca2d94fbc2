"""The form for what has no verb: ``perform Name on A and B``."""

from capar.model.par import Call
from kb.language.instruction import Instruction
from kb.language.reading.matching import hands_and_source
from kb.language.reading.noun_phrases import noun_phrase
from kb.language.reading.reader import Reader
from kb.language.reading.verb_phrases import VerbPhrase, complete


def performed(reader: Reader, agent: str) -> Instruction:
    """Read the name of an action and its objects.

    Raises:
        SentenceError: There is no name, or no object where one should stand.
    """
    cursor = reader.cursor
    if cursor.done:
        known = {each.action for each in reader.words.entries}
        raise cursor.error("the name of an action is missing", known)
    name = cursor.quoted() if cursor.peek().startswith('"') else cursor.take().text
    objects: list[str] = []
    while cursor.accept("and") if objects else cursor.accept("on"):
        at = cursor.at
        noun = noun_phrase(reader, coordinate=False)
        if noun is None or noun.unknown or not (noun.things or noun.limb):
            raise cursor.error("no object", sorted(reader.words.objects or ()), at=at)
        objects.append(noun.things[0] if noun.things else noun.limb)
    phrase = complete(reader, VerbPhrase((), cursor.at))
    ee, source = hands_and_source(reader, phrase)
    return Instruction(Call(name, tuple(objects), phrase.purpose), ee, agent, source)
