#!/usr/bin/env python3
"""Checks that sources include the precompiled headers whose names they use, so that they also compile without them.

usage: check_includes.py FOLDER

FOLDER is a checkout. A source may include a header itself or through headers of the project. Exit status 1 when a
source is listed.
"""

import re
import sys
from functools import lru_cache
from pathlib import Path

from check_layers import without_text

FOLDERS = ("src", "apps", "lab", "bench", "python", "fuzz", "tests")
SEARCHED = ("src", "apps/prostm", "lab", "bench", "tests", "tests/support", "fuzz", "python", ".")
# the headers of cmake/prostm_stage.cmake, with names that only they declare
NAMES = {
    "Eigen/Core": r"Eigen::(?:Vector|Matrix|Array|Map|Index|Ref)\w*",
    "boost/container/static_vector.hpp": r"boost::container::static_vector",
    "algorithm": r"std::(?:sort|stable_sort|nth_element|partial_sort|find|find_if|count|count_if|copy|copy_n|copy_if|fill|"
                 r"fill_n|min_element|max_element|minmax_element|clamp|transform|any_of|all_of|none_of|reverse|rotate|"
                 r"unique|lower_bound|upper_bound|generate|replace|remove_if|ranges::\w+)\b\s*\(",
    "chrono": r"std::chrono::",
    "complex": r"std::(?:complex\b|polar\()",
    "condition_variable": r"std::condition_variable",
    "functional": r"std::(?:function|bind|ref|cref|hash|less|greater)\b\s*[<(]",
    "memory": r"std::(?:unique_ptr|shared_ptr|make_unique|make_shared|weak_ptr)\b",
    "mutex": r"std::(?:mutex|lock_guard|unique_lock|scoped_lock|once_flag|call_once)\b",
    "optional": r"std::(?:optional|nullopt)\b",
    "random": r"std::(?:mt19937\w*|uniform_\w+_distribution|normal_distribution|random_device)\b",
    "span": r"std::span\b",
    "string": r"std::(?:string|to_string|stoi|stod)\b(?!_view)",
    "thread": r"std::(?:thread|jthread|this_thread|stop_token)\b",
    "variant": r"std::(?:variant|visit|get_if|holds_alternative|monostate)\b",
    "vector": r"std::vector\b",
}
# headers that the standard guarantees to declare the names of others
ALSO = {"string": ("filesystem", "fstream", "sstream", "iostream"), "functional": ("memory",),
        "algorithm": ("ranges",), "complex": ("unsupported/Eigen/FFT",), "thread": ("stop_token",)}
INCLUDE = re.compile(r'^\s*#include [<"]([^">]+)[">]', re.M)


class Checkout:
    def __init__(self, root):
        self.root = Path(root)
        self.reach = lru_cache(maxsize=None)(self._reach)

    def resolve(self, source, name):
        for base in (source.parent, *(self.root / folder for folder in SEARCHED)):
            if (base / name).is_file():
                return (base / name).resolve()
        return None

    def _reach(self, source):
        """The headers of others that a file includes, directly or through the project's; cycles end at #pragma once."""
        seen, found, todo = set(), set(), [source]
        while todo:
            path = todo.pop()
            if path in seen:
                continue
            seen.add(path)
            for name in INCLUDE.findall(path.read_text()):
                header = self.resolve(path, name)
                (todo.append(header) if header else found.add(name))
        return found

    def missing(self, source):
        """(header, name) for each precompiled header that a source uses and does not reach."""
        code = without_text(source.read_text())
        reached = self.reach(source)
        for header, names in NAMES.items():
            use = re.search(names, code)
            if header.startswith("Eigen/") and any("Eigen/" in name for name in reached):
                continue  # every module of Eigen includes its core
            if use and header not in reached and not reached.intersection(ALSO.get(header, ())):
                yield header, use[0].rstrip("( <")

    def listed(self):
        for folder in FOLDERS:
            for source in sorted((self.root / folder).rglob("*.cpp")):
                for header, name in self.missing(source.resolve()):
                    yield f"{source.relative_to(self.root)}: uses {name} and does not include <{header}>"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    lines = list(Checkout(Path(sys.argv[1]).resolve()).listed())
    print("\n".join(lines) if lines else "includes: sources include the precompiled headers that they use")
    sys.exit(1 if lines else 0)


if __name__ == "__main__":
    main()
