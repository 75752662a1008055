#include "boards/twin/virtual_module.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "boards/twin/module_wiring.hpp"
#include "firmware/module/module.hpp"

namespace opentmcl {

namespace {

twin::ShaftEncoder encoder_of(ModuleId module, twin::EncoderProperties properties) {
  properties.kind = wiring_of(module).encoder;
  return twin::ShaftEncoder(properties);
}

}  // namespace

/// firmware/hal on the models of the world: one small adapter for each device.
class VirtualModule::Board {
 public:
  explicit Board(VirtualModule& module)
      : world_{module},
        tmc429_(world_),
        tmc262_(world_),
        eeprom_(world_),
        pins_(wiring_of(module.description_.id), world_),
        analog_(world_),
        encoder_(world_),
        hal{tmc429_,
            tmc262_,
            eeprom_,
            pins_,
            analog_,
            encoder_,
            module.ports_.data(),
            static_cast<std::uint8_t>(module.ports_.size()),
            module.options_.can} {}

 private:
  /// Whatever is done through it is done at the time of the firmware's turn.
  struct PresentWorld {
    twin::World& operator*() const {
      module.bring_world_to_present();
      return module.world_;
    }
    twin::World* operator->() const { return &**this; }
    VirtualModule& module;
  };

  struct MotionController final : hal::SpiDevice {
    explicit MotionController(PresentWorld& w) : world(w) {}
    std::uint32_t transfer(std::uint32_t word) override { return world->transfer_tmc429(word); }
    PresentWorld& world;
  };

  struct Driver final : hal::SpiDevice {
    explicit Driver(PresentWorld& w) : world(w) {}
    std::uint32_t transfer(std::uint32_t word) override { return world->transfer_tmc262(word); }
    PresentWorld& world;
  };

  struct EepromDevice final : hal::Eeprom {
    explicit EepromDevice(PresentWorld& w) : world(w) {}
    bool busy() override { return world->eeprom_busy(); }
    void read(std::uint16_t address, std::uint8_t* data, std::size_t length) override {
      world->read_eeprom(address, data, length);
    }
    void write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length) override {
      world->write_eeprom_page(address, data, length);
    }
    PresentWorld& world;
  };

  struct PinBank final : hal::Pins {
    PinBank(const ModuleWiring& board, PresentWorld& w) : wiring(board), world(w) {}
    std::uint32_t inputs() override {
      twin::World& present = *world;
      std::uint32_t levels = present.inputs() & ~bit(hal::InputPin::stall_guard);
      if (present.stall_guard_output()) levels |= bit(hal::InputPin::stall_guard);
      if (present.home_switch()) levels |= bit(hal::InputPin::home_switch);
      if (wiring.shows_encoder_null && present.encoder().near_null()) levels |= bit(hal::InputPin::encoder_null);
      if (wiring.home_switch_is_in0 && (levels & home_and_in0) != 0) levels |= home_and_in0;
      return levels;
    }
    void set_outputs(std::uint32_t levels) override {
      twin::World& present = *world;
      present.set_outputs(levels);
      present.set_driver_disable((levels & bit(hal::OutputPin::driver_disable)) != 0);
      if (wiring.pull_ups_can_be_switched) present.set_pull_ups((levels & bit(hal::OutputPin::pull_ups)) != 0);
    }
    static constexpr std::uint32_t home_and_in0 = bit(hal::InputPin::home_switch) | bit(hal::InputPin::in0);

    const ModuleWiring& wiring;
    PresentWorld& world;
  };

  /// Where the TMCM-1110 measures its supplies, full scale of the 12-bit converter: 40 V for the motor supply, 6.6 V
  /// for the logic supply (docs/decisions/0005-tmcm1110-io.md).
  struct Converter final : hal::Analog {
    explicit Converter(PresentWorld& w) : world(w) {}
    std::int32_t read(hal::AnalogInput input) override {
      constexpr std::int32_t counts = 4095;
      constexpr std::int32_t supply_full_scale = 40'000;  // mV
      constexpr std::int32_t logic_full_scale = 6'600;    // mV
      constexpr std::int32_t logic_supply = 5'000;        // mV
      switch (input) {
        case hal::AnalogInput::ain0:
          return world->analog_input(0);
        case hal::AnalogInput::supply_voltage:
          return world->supply_voltage() / 100;
        case hal::AnalogInput::temperature:
          return world->temperature();
        case hal::AnalogInput::supply_counts:
          return std::min(counts, world->supply_voltage() * counts / supply_full_scale);
        case hal::AnalogInput::logic_supply:
          return logic_supply * counts / logic_full_scale;
      }
      return 0;
    }
    PresentWorld& world;
  };

  struct EncoderInput final : hal::Encoder {
    explicit EncoderInput(PresentWorld& w) : world(w) {}
    std::int32_t count() override { return static_cast<std::int32_t>(world->encoder().count()); }
    bool take_null_event(bool high_active, std::int32_t& count) override {
      const std::optional<std::int64_t> event = world->encoder().take_null_event(high_active);
      if (event) count = static_cast<std::int32_t>(*event);
      return event.has_value();
    }
    PresentWorld& world;
  };

  PresentWorld world_;
  MotionController tmc429_;
  Driver tmc262_;
  EepromDevice eeprom_;
  PinBank pins_;
  Converter analog_;
  EncoderInput encoder_;

 public:
  Hal hal;
};

VirtualModule::VirtualModule(const ModuleDescription& description, std::vector<hal::Port> ports, Options options,
                             twin::TraceObserver* observer)
    : description_(description),
      options_(std::move(options)),
      world_(observer, {options_.machine, encoder_of(description.id, options_.encoder), options_.motor, options_.load,
                        options_.tables}),
      ports_(std::move(ports)),
      board_(std::make_unique<Board>(*this)) {
  restart();
}

VirtualModule::VirtualModule(const ModuleDescription& description, std::vector<hal::Port> ports)
    : VirtualModule(description, std::move(ports), Options{}) {}

VirtualModule::~VirtualModule() = default;

void VirtualModule::restart() {
  const Extensions& extensions = options_.extensions != nullptr ? *options_.extensions : no_extensions;
  module_ = std::make_unique<Module>(description_, board_->hal, extensions);
  next_turn_ = watches_until_ = now_;
}

void VirtualModule::power_cycle() {
  world_.power_cycle();
  restart();
}

void VirtualModule::wake() {
  if (next_firmware_turn() > now_) takes_extra_turn_ = true;
  next_turn_ = watches_until_ = now_;
}

void VirtualModule::take_turn() {
  const Microseconds time = now_;
  const bool is_extra = std::exchange(takes_extra_turn_, false);
  if (is_extra && options_.extra_turns != nullptr) options_.extra_turns->extra_turn(time);
  if (world_.input_changes() != noted_input_changes_) {
    noted_input_changes_ = world_.input_changes();
    module_->note_input_change();
  }
  ++turns_;
  const Microseconds wanted = module_->poll(time);
  if (module_->restart_requested()) {
    restart();
    return;
  }
  next_turn_ = std::max(wanted, time + options_.turn);
  watches_until_ = std::max(module_->due_without_change(wanted), next_turn_);
  if (watches_until_ > next_turn_) bring_world_to_present();
  noted_motion_changes_ = world_.motion_changes();
}

/// A program that waits for a position looks every millisecond. As long as nothing has changed it sees nothing, so
/// these turns are left out: what happens, and when, is the same.
void VirtualModule::leave_out_vain_turns(Microseconds time) {
  const Microseconds end = std::min({watches_until_, time, next_act()});
  if (has_world_changed() || next_turn_ >= end) return;
  world_.advance_to_motion_change(end * twin::ticks_per_microsecond);
  const Microseconds reached = (world_.now() + twin::ticks_per_microsecond - 1) / twin::ticks_per_microsecond;
  if (reached <= next_turn_) return;
  constexpr Microseconds period = Executor::wait_poll_period;
  const Microseconds left_out = (reached - next_turn_ + period - 1) / period;
  next_turn_ = std::min(next_turn_ + left_out * period, watches_until_);
}

/// Taken or left out must not depend on whether time is cut here: a turn takes its time, so later ones would shift.
bool VirtualModule::is_vain_turn() {
  if (next_turn_ >= watches_until_) return false;
  bring_world_to_present();
  return !has_world_changed();
}

Microseconds VirtualModule::next_act() const {
  Microseconds next = never;
  for (const BenchActor* actor : actors_) next = std::min(next, actor->next_act());
  return next;
}

Microseconds VirtualModule::next_turn() const {
  return std::min(next_firmware_turn(), next_act());
}

void VirtualModule::let_actors_act() {
  const bool takes_extra_turn = takes_extra_turn_;
  for (BenchActor* actor : actors_) {
    if (actor->next_act() <= now_) actor->act(*this);
  }
  // They wake the module in every run alike.
  takes_extra_turn_ = takes_extra_turn;
}

void VirtualModule::advance_to(Microseconds time) {
  while (true) {
    if (watches_until_ > next_turn_) leave_out_vain_turns(time);
    const Microseconds act = next_act();
    const Microseconds turn = std::min(next_firmware_turn(), act);
    if (turn > time) break;
    now_ = std::max(now_, turn);
    if (act <= now_) {
      bring_world_to_present();
      let_actors_act();
    }
    if (next_firmware_turn() > now_) continue;
    if (is_vain_turn()) {
      next_turn_ = std::min(next_turn_ + Executor::wait_poll_period, watches_until_);
    } else {
      take_turn();
    }
  }
  now_ = std::max(now_, time);
  bring_world_to_present();
}

}  // namespace opentmcl
