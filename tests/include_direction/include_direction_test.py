#!/usr/bin/env python3
"""Feeds the include-direction check small trees, good and bad."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).with_name("include_direction.py")


def check(files):
    """Writes a tree of {path: text} and returns (exit code, lines printed) of the check."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            file = pathlib.Path(folder, path)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        result = subprocess.run([sys.executable, str(CHECK), folder], capture_output=True, text=True)
        assert not result.stderr, result.stderr
        return result.returncode, result.stdout.splitlines()


class IncludeDirection(unittest.TestCase):
    def assert_clean(self, files):
        code, lines = check(files)
        self.assertEqual((code, lines), (0, [f"include direction: {len(files)} files, 0 violations"]))

    def assert_refused(self, files, start, *fragments):
        code, lines = check(files)
        self.assertEqual(code, 1, lines)
        self.assertEqual(len(lines), 2, lines)
        self.assertTrue(lines[0].startswith(start), lines[0])
        for fragment in fragments:
            self.assertIn(fragment, lines[0])

    def test_accepts_a_layer_that_uses_the_one_below(self):
        self.assert_clean(
            {
                "firmware/hal/time.hpp": "#include <cstdint>\n",
                "firmware/chip/driver.cpp": '#include "firmware/hal/time.hpp"\n',
            }
        )

    def test_refuses_a_layer_that_uses_the_one_above_and_names_what_is_allowed(self):
        self.assert_refused(
            {"firmware/hal/time.hpp": '\n#include "firmware/chip/x.hpp"\n', "firmware/chip/x.hpp": ""},
            'firmware/hal/time.hpp:2: "firmware/chip/x.hpp" is not allowed in firmware/hal',
            "allowed: firmware/hal",
        )

    def test_lets_the_chip_models_read_register_tables_but_no_driver(self):
        tree = {"firmware/chip/tmc429_registers.hpp": "", "firmware/chip/tmc429_driver.hpp": ""}
        self.assert_clean({**tree, "twin/chip/tmc429.hpp": '#include "firmware/chip/tmc429_registers.hpp"\n'})
        self.assert_refused(
            {**tree, "twin/chip/tmc429.hpp": '#include "firmware/chip/tmc429_driver.hpp"\n'}, "twin/chip/tmc429.hpp:1:"
        )

    def test_refuses_the_twin_in_the_firmware(self):
        self.assert_refused(
            {"firmware/module/m.cpp": '#include "twin/world/world.hpp"\n', "twin/world/world.hpp": ""},
            "firmware/module/m.cpp:1:",
        )

    def test_refuses_headers_that_need_a_heap_in_the_firmware_but_not_in_its_tests(self):
        self.assert_refused({"firmware/motion/ramp.cpp": "#include <vector>\n"}, "firmware/motion/ramp.cpp:1: <vector>")
        self.assert_clean({"firmware/motion/ramp_test.cpp": "#include <gtest/gtest.h>\n#include <vector>\n"})

    def test_refuses_the_operating_system_and_libraries_in_twin_and_lang(self):
        self.assert_refused({"twin/chip/x.cpp": "# include <unistd.h>\n"}, "twin/chip/x.cpp:1: <unistd.h>")
        self.assert_refused({"lang/lexer.cpp": "#include <fmt/core.h>\n"}, "lang/lexer.cpp:1: <fmt/core.h>")
        self.assert_clean({"server/pty.cpp": "#include <unistd.h>\n"})

    def test_refuses_clocks_in_the_twin(self):
        self.assert_refused({"twin/world/world.cpp": "#include <chrono>\n"}, "twin/world/world.cpp:1: <chrono>")

    def test_refuses_headers_that_do_not_exist_from_the_root(self):
        self.assert_refused({"lang/a.hpp": "", "lang/a.cpp": '#include "a.hpp"\n'}, 'lang/a.cpp:1: "a.hpp"', "root")

    def test_refuses_project_headers_in_angle_brackets(self):
        self.assert_refused(
            {"lang/a.hpp": "", "lang/a.cpp": "#include <lang/a.hpp>\n"}, "lang/a.cpp:1:", 'write "lang/a.hpp"'
        )

    def test_refuses_includes_by_macro(self):
        self.assert_refused({"lang/a.cpp": "#include HEADER\n"}, "lang/a.cpp:1: #include HEADER")

    def test_refuses_a_folder_without_a_rule(self):
        self.assert_refused({"firmware/new_folder/x.hpp": ""}, "firmware/new_folder/x.hpp:1: this folder has no rule")
        self.assert_refused({"new_folder/x.cpp": ""}, "new_folder/x.cpp:1: this folder has no rule")

    def test_looks_into_neither_comments_nor_raw_strings(self):
        self.assert_clean(
            {
                "lang/a.cpp": "/*\n#include <unistd.h>\n*/\n// it's\n#define n 1'000\n"
                'auto program = R"(\n#include "TMCLParam.tmc"\n)";\nauto path = "//"; auto tick = \'"\';\n'
            }
        )

    def test_counts_lines_through_comments_and_raw_strings(self):
        self.assert_refused(
            {"lang/a.cpp": '/*\n\n*/ auto x = R"tmc(\n)tmc";\n#include <unistd.h>\n'}, "lang/a.cpp:5: <unistd.h>"
        )

    def test_fails_when_there_is_nothing_to_check(self):
        self.assertEqual(check({})[0], 2)


if __name__ == "__main__":
    unittest.main()
