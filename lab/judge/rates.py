"""Sums of pictures, upper limits of rates, and the tables that show them."""

import csv
import math

import numpy as np

import verdict
import views

COUNTS = ("rays", "hits", "wrong", "normal", "undecided", *verdict.KINDS)
COLUMNS = ("class", "solid", "family", "view", "voice", *COUNTS, "note")


def upper(wrong, count):
    """The upper 95 % limit of a share, one-sided, after Clopper and Pearson: the share at which
    `wrong` or fewer of `count` come out in 5 of 100 trials. 1 without a trial."""
    if wrong >= count:
        return 1.0
    i = np.arange(1, wrong + 1)
    ways = np.concatenate([[0.0], np.cumsum(np.log((count - i + 1) / i))])
    low, high = wrong / count, 1.0
    for _ in range(60):
        share = 0.5 * (low + high)
        if not 0.0 < share < 1.0:
            break
        terms = ways + np.arange(wrong + 1) * math.log(share)
        terms += (count - np.arange(wrong + 1)) * math.log1p(-share)
        top = terms.max()
        sum_of = top + math.log(np.exp(terms - top).sum())
        low, high = (share, high) if sum_of > math.log(0.05) else (low, share)
    return high


def write(rows, path):
    """A row for each picture and voice, as CSV."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def total(rows):
    """The sums of all counts."""
    return {name: sum(row[name] for row in rows) for name in COUNTS}


def voices(rows):
    """The names of the voices, in the order in which they come."""
    return list(dict.fromkeys(row["voice"] for row in rows))


def summary(rows):
    """One line a voice: pictures, rays, hits, and what is wrong, as Markdown."""
    lines = ["| voice | pictures | rays | hits | wrong | missed | ghost | depth | wrong normal | undecided |"]
    lines.append("|---|" + "---:|" * 9)
    for voice in voices(rows):
        own = [row for row in rows if row["voice"] == voice and row["note"] == ""]
        if own:
            t = total(own)
            names = ("rays", "hits", "wrong", *verdict.KINDS, "normal", "undecided")
            cells = " | ".join(f"{t[name]:,}" for name in names)
            lines.append(f"| {voice} | {len(own):,} | {cells} |")
    refused = [row for row in rows if row["note"] != ""]
    for voice in dict.fromkeys(row["voice"] for row in refused):
        own = [row for row in refused if row["voice"] == voice]
        lines.append(f"\n{voice} refused {len(own)} pictures; the first: {own[0]['note']}")
    return "\n".join(lines)


def by_class(rows, count="wrong"):
    """One line a voice, one column a class of rays: wrong pixels (or those of another count) of the
    hits, with the upper limit of the share in percent."""
    kinds = [kind for kind in views.CLASSES if any(row["class"] == kind for row in rows)]
    lines = ["| voice | " + " | ".join(kinds) + " |", "|---|" + "---:|" * len(kinds)]
    for voice in voices(rows):
        cells = []
        for kind in kinds:
            own = (r for r in rows if r["voice"] == voice and r["class"] == kind and r["note"] == "")
            t = total(list(own))
            limit = 100 * upper(t[count], t["hits"])
            cells.append(f"{t[count]:,} of {t['hits']:,}; < {limit:.2g}" if t["hits"] else "")
        lines.append(f"| {voice} | " + " | ".join(cells) + " |")
    return "\n".join(lines)
