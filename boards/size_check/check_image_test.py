#!/usr/bin/env python3
"""Gives check_image.py images that are good and images that are bad. Needs no ARM compiler."""

import unittest

import check_image
from check_image import Image, InputSection, Symbol

MAP = """
Discarded input sections

 .text.unused   0x00000000       0x99 firmware/libopentmcl_firmware.a(axis.cpp.obj)

Memory Configuration

Linker script and memory map

LOAD firmware/libopentmcl_firmware.a

.text           0x00000000      0x64c
 *(.text .text.*)
 .text.reset    0x00000010       0x1c boards/size_check/startup.cpp.obj
                0x00000010                reset
 .text._ZN8opentmcl4Axis4stopEv
                0x0000002c       0x20 firmware/libopentmcl_firmware.a(axis.cpp.obj)
 *fill*         0x0000004c        0x4
 .text          0x00000050        0x0 firmware/libopentmcl_firmware.a(axis.cpp.obj)

.data           0x20000000       0x14 load address 0x0000064c
 *(.data .data.*)
 .data.rel.ro.table
                0x20000000       0x14 firmware/libopentmcl_firmware.a(axis.cpp.obj)

.debug_info     0x00000000     0x1000
 .debug_info    0x00000000     0x1000 firmware/libopentmcl_firmware.a(axis.cpp.obj)
"""


def image(text=1000, data=0, bss=100, symbols=(), sections=()):
    return Image(text, data, bss, list(symbols), list(sections))


def violations(candidate, folder="firmware/motion"):
    return check_image.violations(candidate, lambda section: folder)


class CheckImage(unittest.TestCase):
    def test_reads_from_the_map_what_is_in_the_image_and_from_where(self):
        archive = "firmware/libopentmcl_firmware.a(axis.cpp.obj)"
        self.assertEqual(
            check_image.sections_of(MAP),
            [
                InputSection(".text", ".text.reset", 0x1C, "boards/size_check/startup.cpp.obj"),
                InputSection(".text", ".text._ZN8opentmcl4Axis4stopEv", 0x20, archive),
                InputSection(".data", ".data.rel.ro.table", 0x14, archive),
            ],
        )

    def test_reads_symbols_with_and_without_a_size(self):
        self.assertEqual(
            check_image.symbols_of("reset T 234 1c\nstack_top A 20008000\n"),
            [Symbol("reset", "T", 0x1C), Symbol("stack_top", "A", 0)],
        )

    def test_accepts_an_image_at_the_limits(self):
        self.assertEqual(violations(image(text=48 * 1024, bss=16 * 1024)), [])

    def test_refuses_one_byte_more(self):
        self.assertIn("1 above the limit", violations(image(text=48 * 1024 + 1))[0])
        self.assertIn("1 above the limit", violations(image(bss=16 * 1024 + 1))[0])

    def test_names_the_table_that_landed_in_ram(self):
        section = InputSection(".data", ".data.axis_parameters", 20, "x.obj")
        self.assertIn(".data.axis_parameters", violations(image(data=20, sections=[section]))[0])

    def test_refuses_data_that_nothing_explains(self):
        self.assertEqual(len(violations(image(data=4))), 1)

    def test_refuses_constructors_before_main(self):
        section = InputSection(".init_array", ".init_array", 4, "x.obj")
        self.assertIn("constructor before main", violations(image(data=4, sections=[section]))[0])

    def test_refuses_mutable_globals_of_the_firmware_but_not_of_the_board(self):
        section = InputSection(".bss", ".bss.counter", 4, "x.obj")
        self.assertIn("mutable global", violations(image(sections=[section]))[0])
        self.assertEqual(violations(image(sections=[section]), folder="boards/size_check"), [])

    def test_refuses_heap_runtime_and_floating_point(self):
        for name in (
            "malloc", "_malloc_r", "free", "_sbrk", "_Znwj", "_ZdaPv", "__cxa_atexit", "__cxa_pure_virtual",
            "_Unwind_Resume", "__aeabi_unwind_cpp_pr0", "__aeabi_dadd", "__aeabi_fmul", "__aeabi_cdcmple", "__aeabi_i2d",
            "__aeabi_ul2f", "__adddf3", "__floatsisf", "__fixunsdfsi",
        ):  # fmt: skip
            with self.subTest(name):
                self.assertEqual(len(violations(image(symbols=[Symbol(name, "T", 8)]))), 1)

    def test_accepts_integer_division_and_memory_functions(self):
        names = ("__aeabi_uldivmod", "__aeabi_ldivmod", "__udivmoddi4", "__aeabi_idiv0", "__aeabi_llsl", "memcpy", "memset")
        self.assertEqual(violations(image(symbols=[Symbol(name, "T", 8) for name in names])), [])


if __name__ == "__main__":
    unittest.main()
