#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "boards/twin/paced_port.hpp"
#include "boards/twin/virtual_module.hpp"
#include "client/error.hpp"
#include "server/farm.hpp"
#include "server/farm_description.hpp"
#include "server/farm_doors.hpp"
#include "server/kept_eeprom.hpp"
#include "server/memory_line.hpp"
#include "server/rs485_line.hpp"

namespace opentmcl::server {

/// A farm built: modules on their lines with doors open, programs loaded, ready to run.
class FarmSite {
 public:
  /// The assembled program of a module that wants one.
  using Programs = std::function<const std::vector<Command>&(const FarmModule& module)>;

  /// Errors name the module or bus: usage, bad_file, input_output.
  static client::Result<std::unique_ptr<FarmSite>> build(boost::asio::io_context& events, FarmDescription description,
                                                         Programs programs, Farm::Options options,
                                                         WallClock clock = std::chrono::steady_clock::now);
  ~FarmSite();
  FarmSite(const FarmSite&) = delete;
  FarmSite& operator=(const FarmSite&) = delete;

  Farm& farm() { return *farm_; }

  /// Something with doors, for whoever lists them.
  struct Place {
    const char* kind;  ///< "PD-1161", "TMCM-1110", "RS485" or "CAN"
    const std::string* name;
    const OpenDoors* doors;
    bool is_bus = false;
    const std::string* bus = nullptr;  ///< name of what a module is on, if anything
    unsigned address = 0;              ///< of a module on a bus
  };
  /// Modules in the order of the description, then lines and buses.
  std::vector<Place> places() const;

  std::size_t module_count() const { return modules_.size(); }
  VirtualModule& module(std::size_t index);

  /// Lets modules finish what they have been told to store and saves the last of it. The first error of saving, also of
  /// any time before: run() ends then.
  client::Result<void> finish();

 private:
  struct Module;
  struct Line;
  struct Bus;

  FarmSite(boost::asio::io_context& events, FarmDescription description, Programs programs, WallClock clock);

  client::Result<void> build_buses();
  client::Result<void> build_module(std::size_t index);
  client::Result<void> set_up_module(std::size_t index);
  void build_farm(Farm::Options options);
  Simulated& simulated_of(std::size_t index);
  RequestsArrived serving(std::size_t member);
  void save(std::size_t member);

  boost::asio::io_context& events_;
  FarmDescription description_;
  std::shared_ptr<twin::TorqueTables> tables_ = std::make_shared<twin::TorqueTables>();  ///< of all motors
  Programs programs_;
  WallClock clock_;
  std::vector<std::unique_ptr<Line>> lines_;
  std::vector<std::unique_ptr<Bus>> buses_;
  std::vector<std::unique_ptr<Module>> modules_;
  std::vector<std::vector<std::size_t>> member_modules_;  ///< by member of the farm: first the lines, then the rest
  /// By member. Most turns are of modules that keep none, and to look at each of thousands of them costs memory
  /// accesses.
  std::vector<bool> keeps_eeproms_;
  std::unique_ptr<Farm> farm_;
  client::Result<void> outcome_;
};

}  // namespace opentmcl::server
