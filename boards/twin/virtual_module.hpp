#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "boards/twin/simulated.hpp"
#include "firmware/hal/hal.hpp"
#include "firmware/spec/modules.hpp"
#include "twin/world/world.hpp"

namespace opentmcl {

class Module;
struct Extensions;

class VirtualModule;

/// Somebody at the bench who does something at certain times, always the same in every run: the events of a scenario, a
/// recorded session.
class BenchActor {
 public:
  /// When it next wants to act; `never` when it is done. A time in the past means now.
  virtual Microseconds next_act() const = 0;
  /// Called at that time, before the firmware takes a turn at it. Must not let time pass.
  virtual void act(VirtualModule& module) = 0;

 protected:
  ~BenchActor() = default;
};

/// Hears of the turns that a module takes only because somebody has woken it. When that is, is up to whoever carries
/// the module and not to the module; who hears of it can wake it at the same times in another run.
class ExtraTurnObserver {
 public:
  /// Called before the turn.
  virtual void extra_turn(Microseconds now) = 0;

 protected:
  ~ExtraTurnObserver() = default;
};

/// A module as on the bench: the firmware on a board whose chips, motor and EEPROM are models. It only knows simulated
/// time; the same bytes at the same times give the same replies and the same motion.
class VirtualModule final : public Simulated {
 public:
  struct Options {
    /// Length of a turn of the firmware's main loop while a TMCL program runs: one instruction each. A property of the
    /// microcontroller that nobody has published (docs/decisions/0008-main-loop-turn.md).
    Microseconds turn = 100;
    /// User functions and bank 1; none if nullptr, else it must outlive the module.
    const Extensions* extensions = nullptr;
    /// The machine on the shaft.
    twin::MachineDimensions machine = twin::LinearStageDimensions{};
    /// The encoder on it; its kind is that of the module, whatever is said here.
    twin::EncoderProperties encoder{};
    /// The motor; nothing: an ideal one, whose rotor is always where the field is.
    std::optional<twin::MotorData> motor = {};
    /// What pulls at the machine. N on a linear stage, N m elsewhere.
    double load = 0;
    /// May be shared by the modules of a process; own ones if empty.
    std::shared_ptr<twin::TorqueTables> tables = {};
    /// The module's end of a CAN bus, or none; must outlive the module. A PD-1161 does not look at it.
    hal::CanPort* can = nullptr;
    /// May be nullptr, else it must outlive the module.
    ExtraTurnObserver* extra_turns = nullptr;
  };

  /// @param ports at most 4; what they point to must outlive the module
  /// @param observer hears every signal of the world; may be nullptr, else it must outlive the module
  VirtualModule(const ModuleDescription& description, std::vector<hal::Port> ports, Options options,
                twin::TraceObserver* observer = nullptr);
  VirtualModule(const ModuleDescription& description, std::vector<hal::Port> ports);
  ~VirtualModule();

  VirtualModule(const VirtualModule&) = delete;
  VirtualModule& operator=(const VirtualModule&) = delete;

  const ModuleDescription& description() const { return description_; }

  /// Simulated time since the module was made.
  Microseconds now() const override { return now_; }

  /// Runs firmware and world up to and including `time`; a time in the past changes nothing.
  void advance_to(Microseconds time) override;

  /// `actor` acts from now on, those that were added earlier first; it must outlive the module.
  void add_actor(BenchActor& actor) { actors_.push_back(&actor); }

  /// `actor` acts no more. @pre not called while one acts
  void remove_actor(const BenchActor& actor) { std::erase(actors_, &actor); }

  /// Something happened outside, such as bytes on a port: the firmware takes a turn at now() in the next advance_to().
  void wake() override;

  /// Turns that the firmware has taken since the module was made.
  std::uint64_t turns() const { return turns_; }

  /// When the firmware or an actor next needs to run if nothing happens outside; `never` while the firmware only waits
  /// for commands and no actor has anything to do.
  Microseconds next_turn() const override;

  /// Takes the supply away and gives it back: registers and RAM are lost, the EEPROM and the shaft stay.
  void power_cycle();

  /// At now(), also within a turn of the firmware: a port that it writes to may ask for the time.
  twin::World& world() {
    bring_world_to_present();
    return world_;
  }
  const twin::World& world() const { return world_; }
  Module& module() { return *module_; }

 private:
  class Board;

  void restart();
  void take_turn();
  void let_actors_act();
  void bring_world_to_present() {
    const twin::Tick present = now_ * twin::ticks_per_microsecond;
    if (world_.now() < present) world_.advance_to(present);
  }
  /// Since the firmware's last turn, in what a waiting program looks at.
  bool has_world_changed() const {
    return world_.input_changes() != noted_input_changes_ || world_.motion_changes() != noted_motion_changes_;
  }
  void leave_out_vain_turns(Microseconds time);
  bool is_vain_turn();
  Microseconds next_firmware_turn() const { return world_.input_changes() == noted_input_changes_ ? next_turn_ : now_; }
  Microseconds next_act() const;

  const ModuleDescription& description_;
  Options options_;
  twin::World world_;
  std::vector<hal::Port> ports_;
  std::unique_ptr<Board> board_;
  std::unique_ptr<Module> module_;
  std::vector<BenchActor*> actors_;
  /// Many turns of the firmware touch no chip. The world catches up when one does, and before anybody else looks at it.
  Microseconds now_ = 0;
  Microseconds next_turn_ = 0;
  /// Until then the firmware's turns only look whether the motion or a switch has changed.
  Microseconds watches_until_ = 0;
  bool takes_extra_turn_ = false;  ///< the next turn is taken only because somebody woke the module
  std::uint64_t noted_motion_changes_ = 0;
  std::uint64_t turns_ = 0;
  std::uint64_t noted_input_changes_ = 0;  ///< of the world, as the firmware knows of
};

}  // namespace opentmcl
