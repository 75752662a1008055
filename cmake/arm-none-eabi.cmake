# A Cortex-M3 without an operating system, compiled with Debian's arm-none-eabi packages.
#
# Not -ffreestanding: that would also switch off GCC's built-in memcpy and friends (larger code) and half of the
# header-only part of the standard library. That firmware/ really needs no library is shown by the link of
# boards/size_check with -nostdlib, and which headers it may use by tests/include_direction.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR cortex-m3)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)

# There is no start-up code yet when CMake tries the compiler.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

string(JOIN " " CMAKE_CXX_FLAGS_INIT
  -mcpu=cortex-m3 -mthumb
  -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-unwind-tables -fno-asynchronous-unwind-tables
  -ffunction-sections -fdata-sections
  -fstack-usage)

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
