#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints figures on the structure of the sources, and fails if one exceeds its limit: figures.py [ROOT]

With --list, also prints each place that a figure counts."""
import re
import sys
from pathlib import Path

import lint

MAX_FILES, MAX_LONG_FUNCTIONS, LONG_FUNCTION, MANY_MEMBERS = 45, 5, 40, 4
MAX_README_LINES, MAX_README_COLUMNS = 150, 120
SOURCES = {".cpp", ".h", ".ts", ".mjs", ".py"}
PRODUCT = {"codec", "acquisition", "server", "web"}
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)


def files_per_folder(root):
    """Returns the folders with more than MAX_FILES source files, which are too many for a newcomer."""
    folders = {}
    for path in lint.files(root):
        if path.suffix in SOURCES and "corpus" not in path.parts:
            folders.setdefault(path.parent, []).append(path)
    return [f"{folder}: {len(paths)} files" for folder, paths in sorted(folders.items()) if len(paths) > MAX_FILES]


def long_functions(root):
    found = []
    for path in product_files(root, {".cpp", ".h", ".ts"}):
        lines = lint.text(root, path).splitlines()
        found += [f"{path}:{start + 1}: {end - start} lines" for start, end in lint.functions(lines)
                  if end - start > LONG_FUNCTION and not is_type(lines[start]) and not is_table(lines[start])]
    return found


def is_type(line):
    return re.match(r"\s*(class|struct|namespace|export (default )?class)\b", line)


def is_table(line):
    """Whether a function does nothing but return an object, such as the texts of a language."""
    return line.endswith("=> ({")


def headers_without_opening(root):
    """Returns headers whose second line does not begin a sentence on what the header is or does."""
    return [str(path) for path in cpp_files(root, {".h"})
            if not re.match(r"//[^\n]*\n// [A-Z\"'`\[.][^\n]*\n", lint.text(root, path))]


def unused_permissions(root):
    return [fault for _, _, fault in lint.modules(root) if fault.endswith("and does not")]


def positional_initialisers(root):
    """Returns positional initialisers of structs with more than four members."""
    codes = {path: re.sub(r"//[^\n]*", "", lint.text(root, path)) for path in cpp_files(root, {".h", ".cpp"})}
    large = {path: large_structs(code) for path, code in codes.items()}
    found = []
    for path, code in codes.items():
        for match in initialisers(code, visible_structs(path, codes, large)):
            if not re.search(r"(struct|class|enum|namespace)\s+$", code[:match.start()]):
                found.append(f"{path}:{code.count(chr(10), 0, match.start()) + 1}: {match[1]}")
    return found


def initialisers(code, structs):
    """Returns the matches of positional initialisers of these structs, alone or in a list."""
    if not structs:
        return []
    name = r"\b(" + "|".join(sorted(structs)) + r")\b"
    single = re.compile(name + r"(?: \w+)?\s*\{\s*(?![.}\s/])(?!\w+ [^,;{}]*;)")
    listed = re.compile(name + r"(?:, \d+>|>)? \w+(?:\[\w*\])? ?(?:= )?\{\{?\s*\{\s*(?![.}\s/])")
    return [*single.finditer(code), *listed.finditer(code)]


def visible_structs(path, codes, large):
    """Returns the names of large structs that the file defines or includes. Its own structs hide others of the same name."""
    own = set(re.findall(r"^ *struct (\w+)", codes[path], re.M))
    included = set().union(*(large[header] for header in includes(path, codes)))
    return large[path] | (included - own)


def includes(path, codes):
    """Returns the headers that the file includes, directly or not."""
    found, waiting = set(), [path]
    while waiting:
        at = waiting.pop()
        for name in INCLUDE.findall(codes[at]):
            for header in (Path(name), Path("tests") / name, at.parent / name, at.parents[min(1, len(at.parents) - 1)] / name):
                if header in codes and header not in found:
                    found.add(header)
                    waiting.append(header)
    return found


def large_structs(code):
    """Returns the names of aggregates with more than four data members that `code` defines at namespace level."""
    names = set()
    for match in re.finditer(r"^struct (\w+)(?: final)?(?: : [^{]*)? \{\n(.*?)^\};", code, re.M | re.S):
        body = re.sub(r"//[^\n]*|\{[^{}]*\}", "", match[2])
        if re.search(rf"^\s*(explicit )?{match[1]}\(", body, re.M) or "virtual" in body:
            continue
        members = 0
        for statement in re.findall(r"^  (?! )([^()#]*?);", body, re.M | re.S):
            if not re.match(r"(using|static|friend|enum|struct|class|typedef|private|public)\b", statement.strip()):
                members += len(re.sub(r"<[^;]*>", "", statement).split(","))
        if members > MANY_MEMBERS:
            names.add(match[1])
    return names


def long_readme_lines(root):
    return [f"README.md:{number}: {len(line)} columns"
            for number, line in enumerate(lint.text(root, Path("README.md")).splitlines(), 1)
            if len(line) > MAX_README_COLUMNS]


def readme_lines(root):
    return [f"README.md:{number}" for number, _ in enumerate(lint.text(root, Path("README.md")).splitlines(), 1)]


def product_files(root, suffixes):
    return [path for path in lint.files(root) if path.suffix in suffixes and path.parts[0] in PRODUCT]


def cpp_files(root, suffixes):
    """Returns the files of the product and of its tests."""
    return [path for path in lint.files(root) if path.suffix in suffixes and path.parts[0] in PRODUCT | {"tests"}]


FIGURES = (("folders of over 45 source files", files_per_folder, 0),
           ("functions of over 40 lines", long_functions, MAX_LONG_FUNCTIONS),
           ("headers without an opening sentence", headers_without_opening, 0),
           ("permissions that nothing uses", unused_permissions, 0),
           ("positional initialisers of structs of over 4 members", positional_initialisers, 0),
           ("lines of README.md", readme_lines, MAX_README_LINES),
           ("lines of README.md of over 120 columns", long_readme_lines, 0))


def main():
    words = [word for word in sys.argv[1:] if word != "--list"]
    root = Path(words[0] if words else Path(__file__).parents[2]).resolve()
    is_over = False
    for name, measure, limit in FIGURES:
        found = measure(root)
        is_over |= len(found) > limit
        print(f"{name:<54} {len(found):>5}   (limit {limit}){'   too many' if len(found) > limit else ''}")
        if "--list" in sys.argv and measure is not readme_lines:
            print("\n".join(f"    {place}" for place in found))
    sys.exit(is_over)


if __name__ == "__main__":
    main()
