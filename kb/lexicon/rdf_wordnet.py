"""WordNet's verbs as statements: words, senses and synsets of OntoLex, with their ILI."""

from pyoxigraph import Literal, NamedNode, Triple

from kb.lexicon import terms
from kb.lexicon.terms import DEFINITION, LABEL, TYPE, Triples
from kb.lexicon.wordnet import Synset, WordNet, frame_sentence
from ontology import CAPAR, PREFIXES

WORD = NamedNode(terms.ONTOLEX + "Word")
SENSE = NamedNode(terms.ONTOLEX + "LexicalSense")
CONCEPT = NamedNode(terms.ONTOLEX + "LexicalConcept")
HAS_SENSE = NamedNode(terms.ONTOLEX + "sense")
LEXICALISES = NamedNode(terms.ONTOLEX + "isLexicalizedSenseOf")
HYPERNYM = NamedNode(terms.WN + "hypernym")
ILI = NamedNode(terms.WN + "ili")
CLOSE_MATCH = NamedNode(terms.SKOS + "closeMatch")
OEWN = "https://en-word.net/id/oewn-{}-v"


def wordnet_triples(words: WordNet) -> Triples:
    """Every verb of a WordNet, its words first."""
    for lemma in words.lemmas:
        node = terms.verb(lemma)
        written = Literal(lemma.replace("_", " "), language="en")
        yield Triple(node, TYPE, WORD)
        yield Triple(node, LABEL, written)
    sentences = {str(each): Literal(frame_sentence(str(each))) for each in range(1, 36)}
    for word in words:
        yield from synset_triples(word, sentences)


def synset_triples(value: Synset, sentences: dict[str, Literal]) -> Triples:
    """A synset with its senses."""
    node = terms.synset(value.offset)
    yield Triple(node, TYPE, CONCEPT)
    yield Triple(node, DEFINITION, Literal(value.gloss, language="en"))
    yield Triple(node, CAPAR.synsetOffset, Literal(value.offset))
    yield Triple(node, CAPAR.lexicographerFile, terms.number(value.lexfile))
    yield Triple(node, CLOSE_MATCH, NamedNode(OEWN.format(value.offset)))
    if value.ili:
        yield Triple(node, ILI, NamedNode(PREFIXES["ili"] + value.ili))
    for above in value.hypernyms:
        yield Triple(node, HYPERNYM, terms.synset(above))
    for frame in sorted({each.partition(":")[0] for each in value.frames}):
        yield Triple(node, CAPAR.genericSentence, sentences[frame])
    for sense in value.senses:
        own = terms.sense(sense.key)
        yield Triple(terms.verb(sense.lemma.lower()), HAS_SENSE, own)
        yield Triple(own, TYPE, SENSE)
        yield Triple(own, LEXICALISES, node)
        yield Triple(own, CAPAR.senseKey, Literal(sense.key))
        yield Triple(own, CAPAR.senseNumber, terms.number(sense.number))
