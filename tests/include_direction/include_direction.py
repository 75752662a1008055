#!/usr/bin/env python3
"""Checks that every #include points the way the architecture allows.

Usage: include_direction.py PROJECT_ROOT

Prints `file:line: what is wrong; what is allowed` for each violation and exits with 1 when there is one, with 2 when
there was nothing to check. The rules are in rules.py.
"""

import fnmatch
import pathlib
import re
import sys

import rules

SOURCE_SUFFIXES = {".hpp", ".cpp", ".h", ".cc", ".inc"}

# Matches what may hide an #include that is none: comments and raw strings. Ordinary strings and characters are matched
# only to be stepped over (a // inside them starts no comment); so are the ' inside numbers.
NOT_CODE = re.compile(
    r"""(?P<blank> //[^\n]* | /\*.*?\*/ | R"(?P<delimiter>[^\s()\\]{0,16})\(.*?\)(?P=delimiter)" )
      | (?<=[0-9A-Fa-f])'(?=[0-9A-Fa-f])
      | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*'""",
    re.VERBOSE | re.DOTALL,
)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"(?P<quoted>[^"\n]*)"|<(?P<angled>[^>\n]*)>|(?P<other>[^\n]*))', re.M)


def without_comments_and_raw_strings(text):
    """The same text with those blanked out; every line keeps its number."""
    return NOT_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]) if match["blank"] else match[0], text)


def includes_of(text):
    """Yields (line number, kind, name) for each #include; kind is "quoted", "angled" or "other"."""
    code = without_comments_and_raw_strings(text)
    for match in INCLUDE.finditer(code):
        kind = match.lastgroup
        yield code.count("\n", 0, match.start()) + 1, kind, match[kind].strip()


def is_within(path, folder):
    return path == folder or path.startswith(folder + "/")


def rule_for(path):
    """The rule of the longest folder that holds the file, or None."""
    holding = [rule for rule in rules.RULES if is_within(path, rule.folder)]
    return max(holding, key=lambda rule: len(rule.folder), default=None)


def complaint_about(kind, name, path, rule, root):
    """What is wrong with one #include, or None."""
    is_test = path.endswith(rules.TEST_SUFFIXES)
    if kind == "other":
        return f"#include {name} cannot be checked; name the header directly"
    if kind == "angled":
        allowed = rule.system
        if allowed is None or name in allowed or (is_test and name in rules.TEST_SYSTEM):
            return None
        if (root / name).exists():
            return f'<{name}> is a header of this project; write "{name}"'
        return f"<{name}> is not allowed in {rule.folder}; allowed: {', '.join(sorted(allowed))}"
    if not (root / name).is_file():
        return f'"{name}" does not exist; headers are included by their path from the project\'s root'
    may_include = (rule.folder, *rule.may_include)
    if any(is_within(name, folder) or fnmatch.fnmatchcase(name, folder) for folder in may_include):
        return None
    return f'"{name}" is not allowed in {rule.folder}; allowed: {", ".join(may_include)}'


def violations_in(root):
    """Returns the number of files checked and the complaints about them."""
    checked, complaints = 0, []
    tops = [top for top in root.iterdir() if top.is_dir() and not top.name.startswith((".", "build"))]
    for top in sorted(tops):
        for file in sorted(top.rglob("*")):
            if file.suffix not in SOURCE_SUFFIXES or not file.is_file():
                continue
            checked += 1
            path = file.relative_to(root).as_posix()
            rule = rule_for(path)
            if rule is None:
                complaints.append(f"{path}:1: this folder has no rule; add one to tests/include_direction/rules.py")
                continue
            for line, kind, name in includes_of(file.read_text(encoding="utf-8")):
                complaint = complaint_about(kind, name, path, rule, root)
                if complaint:
                    complaints.append(f"{path}:{line}: {complaint}")
    return checked, complaints


def main(root):
    checked, complaints = violations_in(root)
    for complaint in complaints:
        print(complaint)
    print(f"include direction: {checked} files, {len(complaints)} violations")
    if checked == 0:
        return 2
    return 1 if complaints else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
