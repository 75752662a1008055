"""`tmcl asm`: what it prints and what it writes."""

import json
import os
import pty
import shutil
import subprocess

import tmcl_host
from tmcl_host import TemporaryFolderTest, tmcl_path

PROGRAM = "Speed = 1000\nLoop: ROR 0, Speed\n  JA Loop\n"
BAD = "Unused = 5\nROR 0, 51200\n"  # two warnings


class AssemblerTest(TemporaryFolderTest):
    def expect(self, code, *arguments, **options):
        done = self.tmcl("asm", *arguments, **options)
        self.assertEqual(code, done.returncode, "%r: %s" % (arguments, done.stderr))
        return done

    def assemble(self, text, *arguments, code=0):
        return self.expect(code, self.write("p.tmc", text), *arguments)

    def json(self, text, *arguments, code=0):
        return json.loads(self.assemble(text, "--json", *arguments, code=code).stdout)


class Files(AssemblerTest):
    def test_are_written_all_at_once(self):
        self.assemble(PROGRAM, "-o", self.path("o.bin"), "--symbols", self.path("o.sym"), "--listing", self.path("o.lst"),
                      "--source-map", self.path("o.map"), "--c-array", self.path("o.h"))
        self.assertEqual({"p.tmc", "o.bin", "o.sym", "o.lst", "o.map", "o.h"}, set(os.listdir(self.folder)))
        self.assertIn(b"Loop = 0 // label, ", self.read("o.sym"))

    def test_are_not_written_when_there_are_errors(self):
        self.write("p.bin", "old")
        self.assemble("FOO\n", "--symbols", self.path("p.sym"), code=65)
        self.assertEqual(b"old", self.read("p.bin"))
        self.assertEqual({"p.tmc", "p.bin"}, set(os.listdir(self.folder)))

    def test_are_not_written_when_one_of_them_cannot_be(self):
        done = self.assemble(PROGRAM, "--symbols", self.path("nowhere/p.sym"), code=74)
        self.assertIn("nowhere/p.sym", done.stderr)
        self.assertEqual({"p.tmc"}, set(os.listdir(self.folder)))

    def test_replace_what_a_link_leads_to_and_leave_devices_alone(self):
        self.write("real.bin", "old")
        os.symlink("real.bin", self.path("link.bin"))
        self.assemble(PROGRAM, "-o", self.path("link.bin"))
        self.assertTrue(os.path.islink(self.path("link.bin")))
        self.assertEqual(24, len(self.read("real.bin")))
        self.assemble(PROGRAM, "-o", "/dev/null")
        self.assertFalse(os.path.isfile("/dev/null"))

    def test_never_replace_the_source(self):
        source = self.write("p.bin", PROGRAM)
        self.assertIn("is the source", self.expect(64, source).stderr)
        self.assertEqual(PROGRAM.encode(), self.read("p.bin"))

    def test_source_map_has_the_place_of_each_instruction(self):
        self.write("part.tmc", "MST 0\n")
        self.assemble("  #include part.tmc\n\n\tROR 0, 5 // \u00e4\n", "--source-map", self.path("map"))
        source_map = json.loads(self.read("map"))
        self.assertEqual(["p.tmc", "part.tmc"], [os.path.basename(name) for name in source_map["files"]])
        self.assertEqual([{"address": 0, "file": 1, "line": 1, "column": 1, "length": 5},
                          {"address": 1, "file": 0, "line": 3, "column": 2, "length": 8}], source_map["instructions"])
        self.assertEqual((1, 3, "pd1161"), (source_map["version"], source_map["instruction_count"], source_map["module"]))


class CArray(AssemblerTest):
    USE = ('#include <stdio.h>\n#include "pump.h"\n#include "pump.h"\nint main(void) {\n'
           "  for (int i = 0; i < PUMP_PROGRAM_LENGTH; ++i)\n"
           '    for (int k = 0; k < 7; ++k) printf("%02X", pump_program[i][k]);\n  return 0;\n}\n')

    def test_is_taken_by_compilers_of_c_and_of_cplusplus(self):
        self.expect(0, self.write("pump.tmc", "Loop: MVP REL, 0, -10000 / (2 * 1)\nJA Loop\n"), "--c-array", self.path("pump.h"))
        for compiler, standard, name in (("cc", "-std=c99", "use.c"), ("c++", "-std=c++11", "use.cpp")):
            self.assertIsNotNone(shutil.which(compiler), "a compiler is needed for the test")
            source = self.write(name, self.USE)
            subprocess.run([compiler, standard, "-Wall", "-Wextra", "-Wpedantic", "-Werror", source, "-o", self.path("use")],
                           check=True, timeout=tmcl_host.DEADLINE)
            printed = subprocess.run([self.path("use")], capture_output=True, check=True, timeout=tmcl_host.DEADLINE)
            self.assertEqual(b"040100FFFFEC78" + b"16000000000000" + b"1C000000000000", printed.stdout)


class Messages(AssemblerTest):
    def test_end_with_how_many_there_are(self):
        self.assertIn("p.tmc: 2 warnings\n", self.assemble(BAD).stderr)
        self.assertIn("p.tmc: 1 error\n", self.assemble("FOO\n", code=65).stderr)
        self.assertIn("p.tmc: 2 errors, 1 warning\n", self.assemble("FOO\nBAR\nROR 0, 9999\n", code=65).stderr)

    def test_have_colours_on_a_terminal_only(self):
        self.assertNotIn("\033[", self.assemble(BAD).stderr)
        self.assertIn("\033[1;35mwarning: ", self.on_terminal({"TERM": "xterm"}))
        self.assertNotIn("\033[", self.on_terminal({"TERM": "xterm", "NO_COLOR": "1"}))
        self.assertNotIn("\033[", self.on_terminal({"TERM": "dumb"}))

    def on_terminal(self, environment):
        keyboard, screen = pty.openpty()
        done = subprocess.Popen([tmcl_path(), "asm", self.path("p.tmc")], stderr=screen, stdout=subprocess.DEVNULL,
                                stdin=subprocess.DEVNULL, env=environment)
        os.close(screen)
        text = b""
        try:
            while True:
                text += os.read(keyboard, 4096)
        except OSError:  # the other end is closed
            pass
        os.close(keyboard)
        self.assertEqual(0, done.wait(tmcl_host.DEADLINE))
        return text.decode()

    def test_are_json_when_asked_for(self):
        failed = self.json("Loop: MST 0\nJA Lop\n", code=65)
        self.assertNotIn("file", failed)
        problem = failed["diagnostics"][0]
        self.assertEqual(("undefined-name", "error"), (problem["name"], problem["severity"]))
        self.assertEqual((2, 4, 2, 7), tuple(problem["place"][key] for key in ("line", "column", "end_line", "end_column")))
        self.assertEqual("Loop", problem["fix"]["replacement"])
        self.assertEqual(["unused-constant", "operand-out-of-range"], [one["name"] for one in self.json(BAD)["diagnostics"]])


class Warnings(AssemblerTest):
    def names(self, *arguments, code=0):
        return [one["name"] for one in self.json(BAD, *arguments, code=code)["diagnostics"]]

    def test_can_be_switched_off(self):
        self.assertEqual(["operand-out-of-range"], self.names("--no-warning", "unused-constant"))
        self.assertEqual([], self.names("--no-warning", "unused-constant", "--no-warning", "operand-out-of-range"))
        self.assertEqual([], self.names("--no-warning", "all"))
        self.assertIn("did you mean unused-constant?", self.assemble(BAD, "--no-warning", "unused-constants", code=64).stderr)

    def test_can_be_errors(self):
        self.assertIn(": error: ", self.assemble(BAD, "--warnings-as-errors", code=65).stderr)
        self.assertFalse(os.path.exists(self.path("p.bin")))
        self.assertEqual([], self.names("--warnings-as-errors", "--no-warning", "all"))

    def test_are_listed(self):
        listed = self.expect(0, "--list-warnings").stdout
        self.assertIn("stored-in-loop ", listed)
        self.assertNotIn("undefined-name", listed)
        rows = json.loads(self.expect(0, "--list-warnings", "--json").stdout)
        self.assertEqual([line.split()[0] for line in listed.splitlines()], [row["name"] for row in rows])


class Modules(AssemblerTest):
    CALL = "// module: %s\nLoop: CALL ZE, Sub\nJA Loop\nSub: RSUB\n"

    def test_are_what_the_source_says_unless_told_otherwise(self):
        self.assemble(self.CALL % "pd1161")
        self.assertIn("use JC and CSUB", self.assemble(self.CALL % "TMCM-1110", code=65).stderr)
        self.assemble(self.CALL % "tmcm1110", "--module", "pd1161")
        self.assertIn("'tmcm9'", self.assemble(self.CALL % "tmcm9", code=65).stderr)


class BadFiles(AssemblerTest):
    def test_are_one_line(self):
        for name, content, said in (("utf16", PROGRAM.encode("utf-16"), "UTF-16"), ("binary", bytes(range(256)) * 100, "no source"),
                                    ("zeros", bytes(100000), "no source"), ("long", b"MST 0 " * 2000000, "bytes of code")):
            done = self.expect(65, self.write(name, content))
            self.assertIn(said, done.stderr)
            self.assertLess(len(done.stderr), 1000, name)

    def test_are_refused_by_their_size_before_they_are_read(self):
        with open(self.path("huge.tmc"), "wb") as file:
            file.truncate(1 << 40)
        self.assertIn("larger than 64 MiB", self.expect(65, self.path("huge.tmc")).stderr)
        self.assertIn("larger than 64 MiB", self.expect(65, "/dev/zero", "-o", self.path("zero.bin")).stderr)
        self.assertIn("larger than 64 MiB", self.expect(65, self.write("p.tmc", "#include huge.tmc\n")).stderr)

    def test_are_missing_or_folders(self):
        self.assertIn("No such file", self.expect(65, self.path("none.tmc")).stderr)
        self.assertIn("folder", self.expect(65, self.folder).stderr)


if __name__ == "__main__":
    tmcl_host.main()
