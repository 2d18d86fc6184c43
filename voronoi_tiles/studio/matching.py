"""Which values of two versions of a document are the same, and which item of a list has become which."""

from __future__ import annotations

import math
from collections import defaultdict, deque
from collections.abc import Hashable, Mapping, Sequence
from numbers import Real
from typing import Any, Final

_PAIRS_MAX: Final = 4096
"""Most pairs of tables that are compared with each other; a count. Beyond it only their places say which is which."""

_ALIKE: Final = 0.25
"""From which share of equal parts on a table counts as another one, changed; of 1."""

_SAME_KEY: Final = 0.1
"""What it counts that two tables have the same key, whatever it says; of 1."""


def json_form(value: Any) -> Any:
    """A value of TOML in the types of JSON: dates and what is no finite number, for which it has no words, as text."""
    if isinstance(value, Mapping):
        return {key: json_form(item) for key, item in value.items()}
    if isinstance(value, list):
        return [json_form(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    return value if isinstance(value, str | bool | int) else value.isoformat()


def same(old: Any, new: Any) -> bool:
    """Whether a value says the same as another, which may have been to a page in its JSON form and back.

    60 is 60.0, and -0.0 is 0, as JavaScript has no other; 1 is not true.
    """
    if isinstance(old, Mapping):
        return isinstance(new, Mapping) and old.keys() == new.keys() and all(same(old[key], new[key]) for key in old)
    if isinstance(old, list | tuple):
        return isinstance(new, list | tuple) and len(old) == len(new) and all(map(same, old, new))
    if isinstance(old, bool) or isinstance(new, bool):
        return old is new
    if isinstance(old, Real) and isinstance(new, Real):
        return old == new or (old != old and new != new)  # noqa: PLR0124 - not a number
    if isinstance(old, str) or not isinstance(new, str):
        return bool(old == new)
    return bool(json_form(old) == new)


def merged(old: Any, new: Any) -> Any:
    """The new value with the old one in it wherever they say the same: its kinds of numbers, its order of keys."""
    if same(old, new):
        return old
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        both = {key: merged(old[key], new[key]) for key in old if key in new}
        return both | {key: value for key, value in new.items() if key not in old}
    if isinstance(old, list | tuple) and isinstance(new, list | tuple):
        match = matched(old, new)
        return [value if i is None else merged(old[i], value) for i, value in zip(match, new, strict=True)]
    return new


def matched(old: Sequence[Any], new: Sequence[Any]) -> list[int | None]:
    """For every item of a list the index of the one that it was in the list before, None where it was in none.

    Items that are the same are each other wherever they are. Of the others, tables that are alike are each other, and
    what has come to where another has gone; numbers, texts and such go by their places.
    """
    first = 0
    while first < min(len(old), len(new)) and same(old[first], new[first]):
        first += 1
    last = 0
    while last < min(len(old), len(new)) - first and same(old[-1 - last], new[-1 - last]):
        last += 1
    found: list[int | None] = [None] * len(new)
    found[:first] = range(first)
    found[len(new) - last :] = range(len(old) - last, len(old))
    gone, come = range(first, len(old) - last), range(first, len(new) - last)
    if not any(isinstance(item, Mapping | list | tuple) for item in (*old, *new)):
        for i, j in zip(gone, come, strict=False):
            found[j] = i
        return found
    _match_same(old, new, gone, found)
    _match_alike(old, new, found)
    _match_places(old, found)
    return found


def _match_same(old: Sequence[Any], new: Sequence[Any], gone: range, found: list[int | None]) -> None:
    """Match items that have no match, and are the same."""
    known: defaultdict[Hashable, deque[int]] = defaultdict(deque)
    for i in gone:
        known[_key(old[i])].append(i)
    for j, match in enumerate(found):
        if match is None and known.get(key := _key(new[j])):
            found[j] = known[key].popleft()


def _match_alike(old: Sequence[Any], new: Sequence[Any], found: list[int | None]) -> None:
    """Match tables that have no match, and are alike: those first that are most."""
    gone = [i for i in _rest(old, found) if isinstance(old[i], Mapping)]
    come = [j for j, i in enumerate(found) if i is None and isinstance(new[j], Mapping)]
    if len(gone) * len(come) > _PAIRS_MAX:
        return
    pairs = [(_likeness(old[i], new[j]), -abs(a - b), i, j) for a, i in enumerate(gone) for b, j in enumerate(come)]
    taken = set()
    for likeness, _, i, j in sorted(pairs, reverse=True):
        if likeness >= _ALIKE and i not in taken and found[j] is None:
            found[j] = i
            taken.add(i)


def _match_places(old: Sequence[Any], found: list[int | None]) -> None:
    """Match, one after the other, items without a match that come behind the same one."""
    behind: defaultdict[int, deque[int]] = defaultdict(deque)
    matches = set(found)
    before = -1
    for i in range(len(old)):
        if i in matches:
            before = i
        else:
            behind[before].append(i)
    before = -1
    for j, match in enumerate(found):
        if match is not None:
            before = match
        elif behind[before]:
            found[j] = behind[before].popleft()


def _rest(old: Sequence[Any], found: list[int | None]) -> list[int]:
    """The indices of items that are not matched."""
    matches = set(found)
    return [i for i in range(len(old)) if i not in matches]


def _key(value: Any) -> Hashable:
    """What is equal for values that are the same."""
    if isinstance(value, Mapping):
        return frozenset((key, _key(item)) for key, item in value.items())
    if isinstance(value, list | tuple):
        return tuple(map(_key, value))
    if isinstance(value, bool):
        return bool, value
    form = json_form(value)
    return form if isinstance(form, Hashable) else str(form)


def _likeness(old: Any, new: Any) -> float:
    """How much of a value is equal in another, from 0 to 1."""
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        both = [_SAME_KEY + (1 - _SAME_KEY) * _likeness(old[key], new[key]) for key in old if key in new]
        return sum(both) / max(len(old), len(new), 1)
    if isinstance(old, list | tuple) and isinstance(new, list | tuple):
        parts = map(_likeness, old, new)
        if len(old) != len(new):
            known = set(map(_key, old))
            parts = map(float, (_key(item) in known for item in new))
        return sum(parts) / max(len(old), len(new), 1)
    return float(same(old, new))
