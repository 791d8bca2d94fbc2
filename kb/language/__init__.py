"""Between PARs and plain English: sentences out of observations, instructions and questions in."""

from kb.language.describe import describe as describe
from kb.language.instruction import Condition as Condition
from kb.language.instruction import Instruction as Instruction
from kb.language.instruction import Plan as Plan
from kb.language.parse import parse as parse
from kb.language.question import Question as Question
from kb.language.vocabulary import sentence as sentence
