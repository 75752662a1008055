# The two functions every folder uses, and the warnings everything is built with.

add_library(opentmcl_warnings INTERFACE)
target_compile_options(opentmcl_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)

# opentmcl_library(NAME SOURCES … [DEPENDS …]): a static library opentmcl_NAME, included from the project's root.
function(opentmcl_library NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(opentmcl_${NAME} STATIC ${ARG_SOURCES})
  add_library(opentmcl::${NAME} ALIAS opentmcl_${NAME})
  target_include_directories(opentmcl_${NAME} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(opentmcl_${NAME} PUBLIC ${ARG_DEPENDS} PRIVATE opentmcl_warnings)
endfunction()

# opentmcl_test(NAME SOURCES … [DEPENDS …]): a GoogleTest program NAME_test; ctest knows each of its tests.
function(opentmcl_test NAME)
  if(NOT OPENTMCL_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${NAME}_test ${ARG_SOURCES})
  target_include_directories(${NAME}_test PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${NAME}_test PRIVATE ${ARG_DEPENDS} opentmcl_warnings GTest::gmock_main rapidcheck)
  # What is tested is optimised as the user gets it; the tests themselves only cost compile time, and g++ 12 warns of
  # overlapping copies in std::string at -O2 and above where there are none (GCC bug 105651).
  target_compile_options(${NAME}_test PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
  # The sanitizer of undefined behaviour is for what is tested: in the tests it only doubles their compile time.
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
    target_compile_options(${NAME}_test PRIVATE -fno-sanitize=undefined)
  endif()
  gtest_discover_tests(${NAME}_test TEST_PREFIX "${NAME}." PROPERTIES TIMEOUT 300 DISCOVERY_TIMEOUT 60)
endfunction()
