#!/usr/bin/env python3
"""Weighs the linked image of the firmware and fails when it grew too big or holds what firmware must not have.

Usage: check_image.py IMAGE.elf IMAGE.map BUILD_FOLDER

Prints text, data and bss, the share of each source folder, the largest symbols and the deepest stack frames.
"""

import collections
import dataclasses
import json
import pathlib
import re
import shlex
import subprocess
import sys

TEXT_LIMIT = 48 * 1024
BSS_LIMIT = 16 * 1024
PROJECT = pathlib.Path(__file__).resolve().parents[2]

FORBIDDEN = [
    (r"_?_?(malloc|calloc|realloc|free)(_r)?|_sbrk(_r)?", "heap"),
    (r"_Zn[wa].*|_Zd[la].*", "heap (operator new or delete)"),
    (r"__cxa_.*|__gxx_personality.*|_Unwind_.*|__aeabi_unwind.*", "C++ runtime"),
    (r"__aeabi_(d|f|cd|cf)\w*|__aeabi_u?[il]2[df]|__\w+[sd]f[23]|__(fix|float)\w+", "floating point"),
]


@dataclasses.dataclass(frozen=True)
class Symbol:
    name: str  # as the linker sees it
    kind: str  # the letter nm prints
    size: int


@dataclasses.dataclass(frozen=True)
class InputSection:
    """A piece of one object file that the linker put into the image."""

    output: str  # .text, .data, .bss, …
    name: str
    size: int
    object: str


@dataclasses.dataclass(frozen=True)
class Image:
    text: int
    data: int
    bss: int
    symbols: list[Symbol]
    sections: list[InputSection]


def symbols_of(nm_output):
    """Reads `nm --print-size --format=posix`: name, letter, address, size."""
    symbols = []
    for line in nm_output.splitlines():
        fields = line.split()
        size = int(fields[3], 16) if len(fields) > 3 else 0
        symbols.append(Symbol(fields[0], fields[1], size))
    return symbols


IN_THE_IMAGE = (".text", ".init_array", ".data", ".bss")
OUTPUT_SECTION = re.compile(r"^(\.[\w.]+)(?:\s|$)")
# The name of an input section stands alone on its line when it is long; address, size and object follow on the next.
INPUT_SECTION = re.compile(r"^ (\.\S+|COMMON)\s+0x[0-9a-f]+\s+0x([0-9a-f]+) (\S.*)$", re.M)


def sections_of(map_text):
    """Reads the part of GNU ld's map that says what went where; what was discarded stands before it."""
    _, _, memory_map = map_text.partition("\nLinker script and memory map\n")
    joined = re.sub(r"^( (?:\.\S+|COMMON))\n\s+(?=0x)", r"\1 ", memory_map, flags=re.M)
    sections, output = [], ""
    for line in joined.splitlines():
        if start := OUTPUT_SECTION.match(line):
            output = start[1]
        elif piece := INPUT_SECTION.match(line):
            sections.append(InputSection(output, piece[1], int(piece[2], 16), piece[3]))
    return [section for section in sections if section.size > 0 and section.output in IN_THE_IMAGE]


def violations(image, folder_of):
    """Everything that is wrong with the image, one sentence each."""
    found = []
    if image.text > TEXT_LIMIT:
        found.append(f"text is {image.text} bytes, {image.text - TEXT_LIMIT} above the limit of {TEXT_LIMIT}")
    if image.bss > BSS_LIMIT:
        found.append(f"bss is {image.bss} bytes, {image.bss - BSS_LIMIT} above the limit of {BSS_LIMIT}")
    for section in image.sections:
        origin = f"{section.name} of {section.object} ({section.size} bytes)"
        if section.output == ".data":
            found.append(f"in RAM instead of flash: {origin}; make it a constexpr C array")
        elif section.output == ".init_array":
            found.append(f"constructor before main: {origin}")
        elif section.output == ".bss" and folder_of(section).startswith("firmware"):
            found.append(f"mutable global in the firmware: {origin}")
    if image.data > 0 and not any(section.output in (".data", ".init_array") for section in image.sections):
        found.append(f"data is {image.data} bytes that the map does not explain")
    for symbol in image.symbols:
        for pattern, what in FORBIDDEN:
            if re.fullmatch(pattern, symbol.name):
                found.append(f"{what} is linked in: {symbol.name}")
    return found


def folder_finder(build_folder):
    """Returns a function from InputSection to the source folder it came from; an archive names only the object, so
    the compile commands tell the rest."""
    folders = collections.defaultdict(set)
    for entry in json.loads((build_folder / "compile_commands.json").read_text()):
        arguments = shlex.split(entry["command"])
        compiled = pathlib.Path(arguments[arguments.index("-o") + 1])
        folders[compiled.name].add(pathlib.Path(entry["file"]).parent.relative_to(PROJECT).as_posix())

    def folder_of(section):
        member = re.search(r"\(([^)]*)\)$", section.object)
        name = member[1] if member else pathlib.Path(section.object).name
        if name in folders:
            return " or ".join(sorted(folders[name]))
        return pathlib.Path(section.object.partition("(")[0]).name  # libgcc.a

    return folder_of


def stack_frames(build_folder):
    """Reads GCC's -fstack-usage files: (bytes, function, kind), deepest first."""
    frames = []
    for file in build_folder.glob("[!C]*/**/*.su"):  # not CMake's own attempts in CMakeFiles/
        for line in file.read_text().splitlines():
            location, size, kind = line.split("\t")
            frames.append((int(size), location.split(":", 3)[3], kind))
    return sorted(frames, reverse=True)


def print_report(image, folder_of, build_folder):
    print(f"text {image.text} of {TEXT_LIMIT}, data {image.data}, bss {image.bss} of {BSS_LIMIT} bytes")
    shares = collections.defaultdict(collections.Counter)
    for section in image.sections:
        shares[folder_of(section)][section.output] += section.size
    print(f"\n{'folder':30} {'text':>7} {'data':>7} {'bss':>7}")
    for folder, share in sorted(shares.items()):
        print(f"{folder:30} {share['.text']:7} {share['.data'] + share['.init_array']:7} {share['.bss']:7}")

    largest = sorted(image.symbols, key=lambda symbol: -symbol.size)[:10]
    names = subprocess.run(
        ["arm-none-eabi-c++filt", *(symbol.name for symbol in largest)], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    print("\nlargest symbols")
    for symbol, name in zip(largest, names):
        print(f"{symbol.size:7} {symbol.kind} {name}")
    print("\ndeepest stack frames")
    for size, function, kind in stack_frames(build_folder)[:5]:
        print(f"{size:7} {kind} {function}")


def main(elf, map_file, build_folder):
    size = subprocess.run(["arm-none-eabi-size", elf], check=True, capture_output=True, text=True).stdout
    text, data, bss = (int(number) for number in size.splitlines()[1].split()[:3])
    nm = subprocess.run(
        ["arm-none-eabi-nm", "--print-size", "--format=posix", elf], check=True, capture_output=True, text=True
    ).stdout
    image = Image(text, data, bss, symbols_of(nm), sections_of(pathlib.Path(map_file).read_text()))
    folder_of = folder_finder(build_folder)
    print_report(image, folder_of, build_folder)
    found = violations(image, folder_of)
    for violation in found:
        print(f"error: {violation}")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]).resolve()))
