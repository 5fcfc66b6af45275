"""Dictionaries as the text of a case file."""
from __future__ import annotations

import re
from typing import Any, Iterator, Mapping

import numpy as np


def literal(value: Any) -> str:
    """A value as TOML has it. Raises TypeError for what no case has.

    >>> literal([1, 2.5, "2*pi", True, {"a": 1}])
    '[1, 2.5, "2*pi", true, {a = 1}]'
    """
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, str):
        escapes = {'"': '\\"', "\\": "\\\\"}
        return '"' + "".join(escapes.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}") for c in value) + '"'
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key)} = {literal(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(literal(inner) for inner in value) + "]"
    if hasattr(value, "__fspath__"):
        return literal(value.__fspath__())
    raise TypeError(f"a case has numbers, texts, lists and dictionaries, and no {type(value).__name__}")


def text_of(case: Mapping[str, Any]) -> str:
    """A case file. Lists of dictionaries are [[tables]].

    >>> print(text_of({"gaussdrift": 1, "time": {"end": 2}, "check": [{"what": "Linf", "max": 0.1}]}), end="")
    gaussdrift = 1
    [time]
    end = 2
    [[check]]
    what = "Linf"
    max = 0.1
    """
    return "".join(line + "\n" for line in _lines(case, ""))


def _lines(table: Mapping[str, Any], path: str) -> Iterator[str]:
    later = []
    for key, value in table.items():
        if isinstance(value, Mapping) or _is_tables(value):
            later.append((f"{path}{_key(key)}", value))
        else:
            yield f"{_key(key)} = {literal(value)}"
    for name, value in later:
        for one in [value] if isinstance(value, Mapping) else value:
            yield f"[{name}]" if isinstance(value, Mapping) else f"[[{name}]]"
            yield from _lines(one, name + ".")


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(one, Mapping) for one in value)


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else literal(key)
