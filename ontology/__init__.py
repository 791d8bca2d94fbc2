"""The words of the knowledge base: terms, shapes, kinds of objects and alignments, as Turtle."""

from ontology.namespace import BASE as BASE
from ontology.namespace import CAPAR as CAPAR
from ontology.namespace import DATA as DATA
from ontology.namespace import PREFIXES as PREFIXES
from ontology.namespace import terms as terms
