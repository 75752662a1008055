// Nothing the firmware's tables have is left out by the statements, no section of the manuals either, and the document
// is what the table gives.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"
#include "firmware/spec/io_ports.hpp"
#include "tests/conformance/document.hpp"
#include "tests/conformance/touched.hpp"

namespace opentmcl::conformance {
namespace {

const ConformanceTable& table() {
  static const ConformanceTable read = read_conformance_table(OPENTMCL_CONFORMANCE_TABLES);
  return read;
}

class Completeness : public testing::TestWithParam<ModuleId> {
 protected:
  const ModuleDescription& module = modules[static_cast<std::size_t>(GetParam())];
  const Touched touched{table(), module};

  /// Smallest and largest value, what is just outside, default, and storing or the refusal to store.
  template <class Spec>
  void expect_parameter(const Spec& spec, Opcode set, Opcode get, Opcode store, Opcode restore) {
    const int number = static_cast<int>(spec.number);
    SCOPED_TRACE(std::string(spec.name) + " " + std::to_string(number));
    const ParameterColumn& column = spec.in(module.id);
    EXPECT_TRUE(touched.has(get, number, 0)) << "never read";
    EXPECT_TRUE(touched.has(set, number, 0)) << "never written";
    if (!allows(column.access, Access::a)) {  // those are stored by each write
      EXPECT_TRUE(touched.has(store, number, 0)) << "never stored";
      EXPECT_TRUE(touched.has(restore, number, 0)) << "never restored";
    }
    if (!allows(column.access, Access::w)) return;
    EXPECT_TRUE(touched.has(set, number, 0, column.minimum)) << "minimum";
    EXPECT_TRUE(touched.has(set, number, 0, column.maximum)) << "maximum";
    if (column.minimum != int32_minimum) {
      EXPECT_TRUE(touched.has(set, number, 0, column.minimum - 1)) << "below";
    }
    if (column.maximum != int32_maximum) {
      EXPECT_TRUE(touched.has(set, number, 0, column.maximum + 1)) << "above";
    }
  }
};

TEST_P(Completeness, EveryInstructionIsTouched) {
  for (const InstructionSpec& row : instructions) {
    EXPECT_TRUE(touched.has_opcode(row.opcode)) << static_cast<int>(row.opcode);
  }
}

TEST_P(Completeness, EveryAxisParameterIsTouchedFromAllSides) {
  for (const AxisParameterSpec& row : axis_parameters) {
    expect_parameter(row, Opcode::sap, Opcode::gap, Opcode::stap, Opcode::rsap);
  }
}

TEST_P(Completeness, EveryGlobalParameterIsTouchedFromAllSides) {
  for (const GlobalParameterSpec& row : global_parameters) {
    expect_parameter(row, Opcode::sgp, Opcode::ggp, Opcode::stgp, Opcode::rsgp);
  }
}

TEST_P(Completeness, EveryInterruptIsTouched) {
  constexpr int bank = static_cast<int>(Bank::interrupt_settings);
  for (const InterruptSpec& row : interrupts) {
    const int number = static_cast<int>(row.number);
    EXPECT_TRUE(touched.has(Opcode::ei, number, 0)) << row.name;
    EXPECT_TRUE(touched.has(Opcode::di, number, 0)) << row.name;
    EXPECT_TRUE(touched.has(Opcode::sgp, number, bank)) << row.name;
    EXPECT_TRUE(touched.has(Opcode::ggp, number, bank)) << row.name;
    if (row.number != Interrupt::global) {
      EXPECT_TRUE(touched.has(Opcode::vect, number, 0)) << row.name;
    }
  }
}

TEST_P(Completeness, EveryPortIsTouched) {
  for (const IoPortSpec& row : io_ports) {
    if (!contains(row.modules, module.id)) continue;
    const int bank = static_cast<int>(row.bank);
    EXPECT_TRUE(touched.has(Opcode::gio, row.port, bank)) << row.symbol;
    if (allows(row.access, Access::w)) {
      EXPECT_TRUE(touched.has(Opcode::sio, row.port, bank)) << row.symbol;
    }
  }
}

TEST_P(Completeness, EveryStatusIsAnswered) {
  for (const StatusSpec& row : status_codes) {
    // Needs an EEPROM that fails, and the EEPROM lock, which the PD-1161 lacks.
    if (row.code == Status::eeprom_store_failed) continue;
    if (row.code == Status::eeprom_locked && module.id == ModuleId::pd1161) continue;
    EXPECT_TRUE(touched.has_status(row.code)) << row.name;
  }
}

TEST_P(Completeness, EverySectionOfTheManualHasStatements) {
  for (const Section& section : table().sections) {
    const std::string& number = number_in(module.id, section);
    if (number.empty()) continue;
    EXPECT_TRUE(is_covered(table(), section, module.id)) << number;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Completeness, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST(Document, IsWhatTheTableGives) {
  const std::ifstream file(OPENTMCL_CONFORMANCE_DOCUMENT);
  std::ostringstream committed;
  committed << file.rdbuf();
  EXPECT_TRUE(committed.str() == document_of(table())) << "docs/conformance.md is not up to date: run "
                                                          "conformance_document > docs/conformance.md";
}

}  // namespace
}  // namespace opentmcl::conformance
