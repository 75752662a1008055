#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "boards/twin/eeprom_file.hpp"
#include "client/error.hpp"
#include "firmware/hal/hal.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/spec/modules.hpp"
#include "scenario/scenario.hpp"

namespace opentmcl::server {

/// All that a session of a virtual module begins with. Two modules with the same setup, which the same things happen
/// to, do the same.
struct SessionSetup {
  /// A serial connector of the module.
  struct Port {
    hal::PortKind kind = hal::PortKind::usb;
    std::uint32_t wire = 0;  ///< bit/s at which bytes come and go; 0: they take no time

    friend bool operator==(const Port&, const Port&) = default;
  };

  const ModuleDescription* module = &pd1161;
  // Unless the scenario says it, by the names that a scenario has for them:
  std::string machine = "stage";  ///< what the motor turns
  std::string motor = std::string(twin::motors().front().name);
  std::string scenario;       ///< the text of a scenario for this module (docs/scenarios.md), or empty
  std::string scenario_name;  ///< of the file that it is from
  Microseconds turn = 100;    ///< VirtualModule::Options::turn
  std::vector<Port> ports;    ///< of the module, in order
  bool has_can = false;       ///< its CAN connector leads somewhere
  EepromFile::Image eeprom = blank_eeprom();

  /// What is plugged in here can be plugged in there.
  bool has_same_doors(const SessionSetup& other) const {
    return module == other.module && ports == other.ports && has_can == other.has_can;
  }

  static EepromFile::Image blank_eeprom();
};

/// What happens in a session by itself. Without a text one with the machine and the usual motor in which nothing
/// happens. Error: bad_file, the lines of docs/scenarios.md.
client::Result<scenario::Scenario> scenario_of(const SessionSetup& setup);

nlohmann::ordered_json to_json(const SessionSetup& setup);
/// Error: bad_file, a sentence without the file's name.
client::Result<SessionSetup> session_setup_from(const nlohmann::json& source);

}  // namespace opentmcl::server
