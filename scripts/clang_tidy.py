#!/usr/bin/env python3
"""Runs clang-tidy over the project's own sources of a build folder and fails on the first kind of complaint.

Usage: clang_tidy.py BUILD_FOLDER

A source that was clean stays clean until a file it includes, its compile command, .clang-tidy or clang-tidy itself
changes; such results are remembered by a hash of all that in ~/.cache/opentmcl/clang-tidy and not computed again.
"""

import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "opentmcl" / "clang-tidy"


@functools.cache
def content_hash(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


@functools.cache
def tool_version():
    return subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True, text=True).stdout


def included_files(command, folder):
    """The source and every header it reads, system headers too, as the compiler lists them for make."""
    arguments = [argument for argument in shlex.split(command) if argument != "-c"]
    if "-o" in arguments:
        at = arguments.index("-o")
        del arguments[at : at + 2]
    rule = subprocess.run([*arguments, "-M"], cwd=folder, check=True, capture_output=True, text=True).stdout
    return [os.path.join(folder, path) for path in shlex.split(rule.replace("\\\n", " "))[1:]]


def configurations_of(source):
    """The project's .clang-tidy and those of the folders down to the source."""
    folders = [folder for folder in pathlib.Path(source).parents if folder == PROJECT or PROJECT in folder.parents]
    return [path for folder in reversed(folders) if (path := folder / ".clang-tidy").exists()]


def key_of(entry):
    """What the verdict on one source depends on. Paths are left out, so that another checkout has the same key."""
    digest = hashlib.sha256()
    digest.update(tool_version().encode())
    for configuration in configurations_of(entry["file"]):
        digest.update(content_hash(configuration).encode())
    digest.update(entry["command"].replace(str(PROJECT), "").encode())
    for path in included_files(entry["command"], entry["directory"]):
        digest.update(content_hash(path).encode())
    return digest.hexdigest()


def check(entry, build_folder):
    """Returns what clang-tidy has to say about one source; nothing when it is clean."""
    remembered = CACHE / key_of(entry)
    if remembered.exists():
        return ""
    result = subprocess.run(
        ["clang-tidy", "--quiet", "-p", str(build_folder), entry["file"]], capture_output=True, text=True
    )
    if result.returncode != 0:
        return result.stdout + result.stderr
    remembered.touch()
    return ""


def main(build_folder):
    entries = [
        entry
        for entry in json.loads((build_folder / "compile_commands.json").read_text())
        if PROJECT in pathlib.Path(entry["file"]).parents and build_folder not in pathlib.Path(entry["file"]).parents
    ]
    if not entries:
        sys.exit(f"{build_folder}: no source of this project in compile_commands.json")
    CACHE.mkdir(parents=True, exist_ok=True)
    dirty = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count()) as workers:
        for complaints in workers.map(lambda entry: check(entry, build_folder), entries):
            if complaints:
                dirty += 1
                print(complaints, flush=True)
    print(f"clang-tidy: {len(entries)} sources, {dirty} with complaints")
    return 1 if dirty else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
