"""Who may include whom. This table is the architecture; include_direction.py only reads it.

A file belongs to the longest folder listed here that it is in. A folder may always include itself.
"""

import dataclasses

# Header-only parts of the standard library that need neither heap, exceptions nor an operating system.
FREESTANDING = frozenset(
    """algorithm array bit climits compare concepts cstddef cstdint cstring initializer_list iterator limits numeric
    optional span string_view tuple type_traits utility version""".split()
)

# C++20 as both compilers in use have it: libstdc++ 12 lacks <format> and <expected>, clang 14 cannot parse <ranges>.
STANDARD = FREESTANDING | frozenset(
    """any atomic barrier bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes clocale cmath codecvt
    complex condition_variable coroutine csetjmp csignal cstdarg cstdio cstdlib ctime cuchar cwchar cwctype deque
    exception execution filesystem forward_list fstream functional future iomanip ios iosfwd iostream istream latch
    list locale map memory memory_resource mutex new numbers ostream queue random ratio regex scoped_allocator
    semaphore set shared_mutex source_location sstream stack stdexcept stop_token streambuf string strstream
    syncstream system_error thread typeindex typeinfo unordered_map unordered_set valarray variant vector""".split()
)

# Time is an argument and runs repeat exactly: the models neither read a clock nor start threads.
TIMELESS = STANDARD - frozenset(
    """atomic barrier chrono condition_variable ctime future latch mutex semaphore shared_mutex stop_token
    thread""".split()
)

ANY_SYSTEM_HEADER = None


@dataclasses.dataclass(frozen=True)
class Rule:
    """What the files of one folder may include."""

    folder: str
    may_include: tuple[str, ...]  # folders, or files as shell patterns
    system: frozenset[str] | None  # names between < and >; ANY_SYSTEM_HEADER for no limit


# The register tables are the datasheets as data: firmware drivers and chip models read the same rows.
REGISTER_TABLES = ("firmware/chip/register_field.hpp", "firmware/chip/*_registers.hpp")

RULES = (
    Rule("firmware/hal", (), FREESTANDING),
    Rule("firmware/spec", (), FREESTANDING),
    Rule("firmware/wire", ("firmware/spec", "firmware/hal/time.hpp"), FREESTANDING),
    Rule("firmware/chip", ("firmware/hal", "firmware/spec"), FREESTANDING),
    Rule("firmware/motion", ("firmware/chip", "firmware/hal", "firmware/spec"), FREESTANDING),
    # Of wire, param uses the byte order alone: numbers lie in the EEPROM as they go over the line.
    Rule("firmware/param", ("firmware/motion", "firmware/wire", "firmware/hal", "firmware/spec"), FREESTANDING),
    Rule(
        "firmware/tmcl",
        ("firmware/wire", "firmware/param", "firmware/motion", "firmware/hal", "firmware/spec"),
        FREESTANDING,
    ),
    Rule("firmware/module", ("firmware",), FREESTANDING),
    # Where firmware and twin meet: the hal on the models, and a module running on it.
    Rule("boards/twin", ("firmware/hal", "firmware/spec", "firmware/module", "twin"), STANDARD),
    Rule("boards/size_check", ("firmware",), FREESTANDING),
    # What a board may add to the firmware runs on the same microcontroller; its test uses the bench of the module's.
    Rule("examples", ("firmware/tmcl", "tests/module/bench.hpp"), FREESTANDING),
    Rule("twin/chip", REGISTER_TABLES, TIMELESS),
    Rule("twin/physics", (), TIMELESS),
    Rule("twin/world", ("twin/chip", "twin/physics"), TIMELESS),
    Rule("units", ("firmware/spec", "firmware/wire"), STANDARD),
    Rule("lang", ("units", "firmware/spec", "firmware/wire"), STANDARD),
    # Scenarios: what happens to a module and its machine, read from TOML, and recordings of it.
    Rule(
        "scenario",
        (
            "boards/twin",
            "twin",
            "lang",
            "firmware/hal",
            "firmware/spec",
            "firmware/wire",
            "firmware/module/module.hpp",
        ),
        STANDARD | {"toml++/toml.h", "nlohmann/json.hpp"},
    ),
    Rule("client", ("units", "firmware/spec", "firmware/wire"), ANY_SYSTEM_HEADER),
    # The debugger knows modules by their commands alone; what a twin can do beyond that it asks for by an interface.
    Rule("debug", ("client", "lang", "firmware/spec", "firmware/wire", "firmware/hal/time.hpp"), ANY_SYSTEM_HEADER),
    # Where that interface meets the twin.
    Rule(
        "debug/twin",
        (
            "debug",
            "client",
            "lang",
            "scenario",
            "boards/twin",
            "twin",
            "firmware/hal",
            "firmware/spec",
            "firmware/wire",
            "firmware/module/module.hpp",
        ),
        ANY_SYSTEM_HEADER,
    ),
    # A session that is logged has its scenario in the log; recordings are started over the control interface.
    Rule(
        "server",
        ("client", "lang", "scenario", "boards/twin", "twin", "firmware/hal", "firmware/spec", "firmware/wire"),
        ANY_SYSTEM_HEADER,
    ),
    # Servers that an editor starts. What they share knows no protocol above JSON messages.
    Rule("editor", (), ANY_SYSTEM_HEADER),
    # A face of the debugger. How modules are found and sources read it is told by a function that apps/tmcl hands in.
    Rule(
        "editor/dap",
        ("editor/message_*.hpp", "debug", "client", "lang", "units", "firmware/spec", "firmware/wire"),
        ANY_SYSTEM_HEADER,
    ),
    Rule("editor/lsp", ("editor/message_*.hpp", "lang", "units", "firmware/spec"), ANY_SYSTEM_HEADER),
    Rule(
        "apps",
        ("firmware", "boards/twin", "twin", "units", "lang", "scenario", "client", "debug", "server", "editor"),
        ANY_SYSTEM_HEADER,
    ),
    Rule(
        "tests",
        ("firmware", "boards/twin", "twin", "units", "lang", "scenario", "client", "debug", "server", "editor", "apps"),
        ANY_SYSTEM_HEADER,
    ),
)

# A test or benchmark next to its source runs on the host: it may use these and the whole standard library on top.
TEST_SUFFIXES = ("_test.cpp", "_test.hpp", "_bench.cpp")
TEST_SYSTEM = STANDARD | frozenset(
    """gtest/gtest.h gmock/gmock.h rapidcheck.h rapidcheck/gtest.h benchmark/benchmark.h
    boost/numeric/odeint.hpp""".split()
)
