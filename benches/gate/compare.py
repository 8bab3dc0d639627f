"""Compares the numbers of two runs of moduli.

    python3 benches/gate/compare.py BEFORE AFTER [--tolerance 0]

BEFORE and AFTER are two JSON files, or two folders whose .json files are compared by their paths
(files that moduli writes: grasps.json, the results of the experiments, --json lines saved to a
file). Every number, string, boolean and null of BEFORE must be in AFTER, exactly; keys that AFTER
adds are listed and allowed. Timings, paths, numbers of threads and resume keys are not compared.
Binary files (.bin, .shape) are compared byte by byte.

The exit code is 0 when nothing moved, 1 when something did, and 2 when a file cannot be read.
Python's standard library is enough.
"""

import argparse
import json
import math
import pathlib
import re
import sys

# Keys whose values depend on the machine or on the place of the run.
IGNORED = {
    "seconds", "seconds_regression", "us_per_grasp", "thread_seconds", "threads", "output", "trace",
    "grasps_json", "grasps_yaml", "index_html", "page", "file", "cloud", "key",
}
# Endings of keys of the same kind, as in `seconds_by_thread` or `our_seconds`.
IGNORED_ENDINGS = ("_seconds", "_path")
BINARY = {".bin", ".shape"}
SHOWN = 20


def is_ignored(key):
    """Whether a key is of the machine or the place."""
    return key in IGNORED or key.endswith(IGNORED_ENDINGS)


class Comparison:
    """What differs between two values, and what the second one adds."""

    def __init__(self, tolerance):
        self.tolerance = tolerance
        self.compared = 0
        self.moved = []
        self.added = {}

    def values(self, place, before, after):
        """Walks through two values."""
        if isinstance(before, dict) and isinstance(after, dict):
            for key, value in before.items():
                if is_ignored(key):
                    continue
                inside = f"{place}.{key}"
                if key in after:
                    self.values(inside, value, after[key])
                else:
                    self.moved.append(f"{inside}: removed")
            for key in after.keys() - before.keys():
                if not is_ignored(key):
                    general = without_indices(f"{place}.{key}")
                    self.added[general] = self.added.get(general, 0) + 1
        elif isinstance(before, list) and isinstance(after, list):
            if len(before) != len(after):
                self.moved.append(f"{place}: {len(before)} entries, now {len(after)}")
            for index, (a, b) in enumerate(zip(before, after)):
                self.values(f"{place}[{index}]", a, b)
        else:
            self.compared += 1
            if not self.same(before, after):
                self.moved.append(f"{place}: {before!r}, now {after!r}")

    def same(self, before, after):
        """Whether two leaves agree."""
        numbers = (int, float)
        both = isinstance(before, numbers) and isinstance(after, numbers)
        if both and not isinstance(before, bool) and not isinstance(after, bool):
            if math.isnan(before) or math.isnan(after):
                return math.isnan(before) and math.isnan(after)
            return before == after or abs(before - after) <= self.tolerance * abs(before)
        return type(before) is type(after) and before == after


def without_indices(place):
    """The place with `[]` for every entry of a list."""
    return re.sub(r"\[\d+\]", "[]", place)


def files(root):
    """Comparable files by their path below a folder; the file itself for a file."""
    if root.is_file():
        return {"": root}
    if not root.is_dir():
        sys.exit(fail(f"{root}: no such file or folder"))
    wanted = {".json"} | BINARY
    found = (p for p in sorted(root.rglob("*")) if p.is_file() and p.suffix in wanted)
    return {str(p.relative_to(root)): p for p in found if not hidden(p.relative_to(root))}


def hidden(path):
    """Whether a file or one of its folders has a name that begins with a dot."""
    return any(part.startswith(".") for part in path.parts)


def fail(message):
    """Says why nothing can be compared; the exit code."""
    print(f"error: {message}", file=sys.stderr)
    return 2


def load(path):
    """A JSON file, which NaN and Infinity may stand in."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        sys.exit(fail(f"{path}: {error}"))


def main():
    """Compares and reports."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=0.0, help="relative, 0 by default")
    options = parser.parse_args()
    before, after = files(options.before), files(options.after)
    if not before:
        return fail(f"{options.before}: holds nothing to compare")
    comparison = Comparison(options.tolerance)
    for name, path in before.items():
        if name not in after:
            comparison.moved.append(f"{name}: missing")
        elif path.suffix in BINARY:
            comparison.compared += 1
            if path.read_bytes() != after[name].read_bytes():
                comparison.moved.append(f"{name}: other bytes")
        else:
            comparison.values(name, load(path), load(after[name]))
    for name in sorted(after.keys() - before.keys()):
        print(f"added file  {name}")
    for place, count in sorted(comparison.added.items()):
        print(f"added key   {place}  ({count} times)")
    for line in comparison.moved[:SHOWN]:
        print(f"moved       {line}")
    hidden_lines = len(comparison.moved) - SHOWN
    if hidden_lines > 0:
        print(f"moved       … and {hidden_lines} more")
    print(f"{comparison.compared} values compared, {len(comparison.moved)} moved")
    return 1 if comparison.moved else 0


if __name__ == "__main__":
    sys.exit(main())
