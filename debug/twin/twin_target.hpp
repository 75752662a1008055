#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "client/client.hpp"
#include "debug/target.hpp"
#include "debug/twin/frozen_transport.hpp"
#include "debug/twin_powers.hpp"
#include "scenario/scenario.hpp"
#include "scenario/scenario_run.hpp"
#include "twin/chip/eeprom.hpp"

namespace opentmcl::debug {

/// All that a twin to be debugged begins with.
struct TwinSetup {
  /// The module, the bench around it and what happens at it. Its time begins with the program's.
  scenario::Scenario scenario;
  Microseconds turn = 100;                         ///< VirtualModule::Options::turn
  std::optional<twin::Eeprom::Image> eeprom = {};  ///< fresh from the factory if there is none
};

/// A virtual module in this process whose time stands still while nobody steps its program: commands are carried out
/// in between, at no time at all, and a program that is stepped does exactly what it does when it runs.
///
/// It goes back in time by beginning anew and doing again what was done to it, which it keeps a list of
/// (docs/decisions/0070-going-back.md).
class TwinTarget final : public Target, private TwinPowers, private FrozenTransport::Module {
 public:
  /// Hears what the scenario says, once for each moment of its history.
  using Listener = std::function<void(const scenario::Report&)>;

  explicit TwinTarget(TwinSetup setup, Listener listener = {});
  ~TwinTarget() override;

  client::Client& client() override { return client_; }
  const ModuleDescription& module() const override { return *setup_.scenario.module; }
  client::Result<client::ProgramStatus> status() override;
  client::Result<client::ProgramStatus> restart() override;
  client::Result<client::ProgramStatus> step(std::uint16_t address, const Command& instruction) override;
  void rest() override {}
  client::Result<void> let_run() override { return {}; }
  client::Result<client::ProgramStatus> halt() override { return status(); }
  client::Result<client::ProgramStatus> jump(std::uint16_t address) override;
  unsigned steps_a_slice() const override { return 2000; }
  TwinPowers* twin() override { return this; }

  const VirtualModule& virtual_module() const { return *module_; }

 private:
  class TwinSignal;

  struct QuantitySet {
    const twin::Quantity* quantity;
    double value;
  };
  /// Something that was done to the module from outside, which changes or may change what it does.
  struct Deed {
    Moment moment;
    std::variant<Command, QuantitySet> what;
  };

  // TwinPowers
  InnerState inner_state() const override;
  std::size_t depth() const override;
  Moment now() const override { return {module_->now(), module_->turns()}; }
  Moment beginning() const override { return beginning_; }
  client::Result<void> go_to(Moment moment, const std::function<bool()>& keep_going) override;
  client::Result<std::unique_ptr<Signal>> signal(std::string_view condition) override;
  client::Result<std::string> quantity(std::string_view name) const override;
  client::Result<void> set_quantity(std::string_view name, double value) override;
  std::vector<std::string_view> quantity_names() const override;
  std::uint8_t troubles() const override;

  // FrozenTransport::Module
  client::Result<std::optional<Datagram>> answer(const Datagram& request) override;
  Microseconds time() const override { return module_->now(); }
  void let_pass(Microseconds duration) override;

  void begin(bool starts_program);
  std::optional<Datagram> carry_out(const Datagram& request, bool& busy);
  void note(const Deed& deed);
  void pass_time_until(Microseconds time);
  void repeat(const Deed& deed);
  void repeat_deeds_until(Moment moment);
  void take_turn();
  bool program_runs() const;

  TwinSetup setup_;
  Listener listener_;
  std::shared_ptr<twin::TorqueTables> tables_ = std::make_shared<twin::TorqueTables>();
  std::unique_ptr<VirtualModule> module_;
  std::optional<scenario::ScenarioRun> scenario_run_;
  FrozenTransport transport_;
  client::Client client_;
  std::vector<Deed> deeds_;
  std::size_t repeated_ = 0;  ///< of the deeds, in the present module
  Moment beginning_;
  Microseconds furthest_ = 0;  ///< what the scenario said until then was heard
  bool was_in_interrupt_ = false;
  std::size_t interrupted_depth_ = 0;
};

}  // namespace opentmcl::debug
