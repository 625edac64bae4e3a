"""Parts of the tests of every option: a result in bits, claims about an option, and the text that documents one without effect."""

import os
import re

import numpy as np

from common import check, hbvib

with open(os.path.join(hbvib.get_include(), "hbvib.h"), encoding="utf-8") as file:
    HEADER = re.sub(r"\s+", " ", re.sub(r"(?m)^\s*///", "", file.read()))
FIELDS = [field.name.lower() for field in hbvib.Field]


def bits(*numbers):
    return tuple(np.asarray(number).tobytes() for number in numbers)


def of_branch(branch):
    """All that a branch tells: status, fields, motions, special points, what was solved."""
    fields = []
    for name in FIELDS:
        try:
            fields.append(branch.field(name).tobytes())
        except (ValueError, NotImplementedError):
            fields.append(b"")
    motions = [branch.harmonics(point).tobytes() for point in range(branch.stored)]
    points = [np.asarray(list_).tobytes() for special in (branch.peaks(), branch.folds()) for list_ in special]
    return int(branch.status), str(branch.reduction), tuple(fields), tuple(motions), tuple(points)


def outcome(call, **options):
    """The result of a call, or its refusal."""
    try:
        return call(**options)
    except (hbvib.Error, TypeError, ValueError, OverflowError) as error:
        return error


class Claim:
    """Effect of an option in one situation: "changes", "refused" with words, or "same" with the phrase of the header that says so."""

    def __init__(self, kind, words=""):
        self.kind, self.words = kind, words


CHANGES = Claim("changes")


def refused(words):
    return Claim("refused", words)


def same(phrase):
    return Claim("same", phrase)


def hold(claim, title, call, reference, text=HEADER, **given):
    """Checks a claim for one option, perturbed alone; `text` documents it."""
    found = outcome(call, **given)
    if isinstance(reference, Exception):
        check(f"{title}: the call without it", False, reference)
    elif claim.kind == "refused":
        check(f"{title} is refused by name", isinstance(found, Exception) and claim.words.lower() in str(found).lower(),
              found if isinstance(found, Exception) else "")
    elif isinstance(found, Exception):
        check(f"{title}: the call", False, f"{type(found).__name__}: {found}")
    elif claim.kind == "changes":
        check(f"{title} changes the result", found != reference)
    else:
        check(f"{title} is documented to have no effect", claim.words in re.sub(r"\s+", " ", text), claim.words)
        check(f"{title} has none", found == reference)
