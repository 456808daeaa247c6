"""Reads the rules of plain English in tools/vale/prostm, which have the format of Vale, and applies them to a text.

It knows Vale's rules `existence` and `substitution`, with the keys below; any other rule or key is an error, so that no
rule is silently ignored.
"""

import re

import yaml

KEYS = {"extends", "message", "level", "ignorecase", "nonword", "tokens", "swap"}
# white space, emphasis and the marks of comments, which stand between two words of a sentence
GAP = r"[*_]*\s(?:[\s*_]|///?<?|\#)*"


class Rule:
    """A pattern, and the message for its matches."""

    def __init__(self, token, better, rule):
        pattern = token if rule.get("nonword") else rf"\b(?:{token})\b"
        pattern = pattern.replace(" ", GAP)
        self.pattern = re.compile(pattern, re.M | (re.I if rule.get("ignorecase") else 0))
        self.message, self.better = rule["message"], better

    def places(self, text):
        """Finds (line, problem) of each match."""
        for found in self.pattern.finditer(text):
            words = re.sub(GAP, " ", found[0])
            values = [words] if not self.better else [self.better, words]
            yield text.count("\n", 0, found.start()) + 1, self.message % tuple(values)


def read_file(path):
    """Returns the rules of one file. Raises ValueError with a sentence."""
    rule = yaml.safe_load(path.read_text(encoding="utf-8"))
    unknown = set(rule) - KEYS
    if unknown:
        raise ValueError(f"{path}: check_words knows no key '{min(unknown)}' of Vale")
    if rule["extends"] == "existence":
        return [Rule(token, "", rule) for token in rule["tokens"]]
    if rule["extends"] == "substitution":
        return [Rule(token, better, rule) for token, better in rule["swap"].items()]
    raise ValueError(f"{path}: check_words knows no rule '{rule['extends']}' of Vale")


def read_rules(folder):
    """Returns the rules of all files of a folder. Raises ValueError if it holds no rule."""
    rules = [rule for path in sorted(folder.glob("*.yml")) for rule in read_file(path)]
    if not rules:
        raise ValueError(f"{folder} has no rules")
    return rules
