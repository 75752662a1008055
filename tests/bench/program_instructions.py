#!/usr/bin/env python3
"""Counts processor instructions per instruction of a TMCL program with valgrind's callgrind.

Usage: program_instructions.py [--build FOLDER] [--limit WHAT=FIGURE ...]

Turns of the main loop are taken back to back while time stands still, one TMCL instruction each (a CALC, COMP, JC, DJNZ
loop, program_loop.hpp):

  instruction  what a turn with a program costs more than one without: the interpreter
  turn         the whole turn, loop and port of the benchmark included

Exit codes: 0 done, 1 a figure is above its limit, 64 usage, 70 a run failed or counts made no sense.
"""

import concurrent.futures
import os
import pathlib
import sys

import callgrind

FIGURES = ("instruction", "turn")


def main():
    arguments = callgrind.Parser(__doc__, limited=FIGURES, what="WHAT", figure="figure").parse_args()
    program = pathlib.Path(arguments.build) / "tests/bench/program_repetitions"
    states = ["running", "idle"]
    try:
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            running, idle = pool.map(lambda state: callgrind.instructions_per_repetition([program, state]), states)
    except (OSError, callgrind.MeasurementError) as error:
        print(error, file=sys.stderr)
        return callgrind.EXIT_INTERNAL

    figures = dict(zip(FIGURES, (running - idle, running)))
    print("\nProcessor instructions per instruction of a program\n")
    for what, figure in figures.items():
        print(f"{what:20}{figure:16.1f}")
    return callgrind.exit_code(figures, arguments.limit)


if __name__ == "__main__":
    sys.exit(main())
