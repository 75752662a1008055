// Prints docs/conformance.md.
#include <exception>
#include <iostream>

#include "tests/conformance/document.hpp"

int main() {
  try {
    std::cout << opentmcl::conformance::document_of(
        opentmcl::conformance::read_conformance_table(OPENTMCL_CONFORMANCE_TABLES));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
