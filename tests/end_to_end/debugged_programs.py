"""Programs that the tests of `tmcl debug` and `tmcl dap` debug."""

COUNTING = """\
// Adds five, three times.
#include TMCLParam.tmc
        SGP 1, 2, 3
Loop:   CSUB Work
        DJNZ 1, Loop
        STOP

Work:   GGP 2, 2
        CALC ADD, 5
        AGP 2, 2
        RSUB
"""
# Lines of it.
READS = 8
CALCULATES = 9
ADDED = 10
LOOPS = 5
ENDLESS = "Loop:   CALC ADD, 1\n        JA Loop\n"
# A global parameter of bank 0.
CODE_PROTECTION = 81
