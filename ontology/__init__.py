"""The words of the knowledge base: terms, shapes, kinds of objects and alignments, as Turtle."""

from ontology.closed import BASE as BASE
from ontology.closed import DATA as DATA
from ontology.namespace import CAPAR as CAPAR
from ontology.namespace import terms as terms
from ontology.vocabularies import PREFIXES as PREFIXES
