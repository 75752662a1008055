#!/usr/bin/env python3
"""Counts processor instructions of a whole virtual module per simulated stretch of time with valgrind's callgrind.

Usage: module_instructions.py [--build FOLDER] [--limit SITUATION=FIGURE ...]

The situations are those of module_bench, with firmware, chips, motor and machine (moving_module.hpp):

  locked_and_observed  10 ms of an even motion, its position read by a host at the end
  program_with_wait    1 s of a program with MVP and WAIT POS
  free_in_full_steps   10 ms of integrated currents
  standing_still       1 s

Exit codes: 0 done, 1 a figure is above its limit, 64 usage, 70 a run failed or counts made no sense.
"""

import concurrent.futures
import os
import pathlib
import sys

import callgrind

REPETITIONS = {
    "locked_and_observed": 1000,
    "program_with_wait": 100,
    "free_in_full_steps": 100,
    "standing_still": 1000,
}


def main():
    arguments = callgrind.Parser(__doc__, limited=REPETITIONS, what="SITUATION", figure="count").parse_args()
    program = pathlib.Path(arguments.build) / "tests/bench/module_repetitions"
    try:
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            counts = pool.map(
                lambda situation: callgrind.instructions_per_repetition([program, situation], REPETITIONS[situation]),
                REPETITIONS,
            )
            figures = dict(zip(REPETITIONS, counts))
    except (OSError, callgrind.MeasurementError) as error:
        print(error, file=sys.stderr)
        return callgrind.EXIT_INTERNAL

    print("\nProcessor instructions per repetition\n")
    for situation, figure in figures.items():
        print(f"{situation:20}{figure:16.1f}")
    return callgrind.exit_code(figures, arguments.limit)


if __name__ == "__main__":
    sys.exit(main())
