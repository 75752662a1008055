#include "twin/world/quantities.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "twin/world/machine_quantities.hpp"
#include "twin/world/motor_quantities.hpp"

namespace opentmcl::twin {
namespace {

using Kind = Quantity::Kind;

constexpr double millivolts = 1000;    // in 1 V
constexpr double milliamperes = 1000;  // in 1 A

std::int32_t rounded(double value) {
  return static_cast<std::int32_t>(std::lround(value));
}

// ---- The motion controller's registers of motor 1

template <class Register>
tmc429::Word<Register> word_of(const World& world) {
  return tmc429::word_in<Register>(world.tmc429().read(tmc429::read_datagram<Register>()));
}

template <class Register>
double register_of(const World& world) {
  return Register::Value::in(word_of<Register>(world));
}

/// V_ACTUAL is the number of steps in 2048 pulse ticks of 32 * 2^PULSE_DIV clocks (datasheet page 37).
double step_rate(const World& world) {
  const double ticks = static_cast<double>(tmc429::pulse_accumulator_size) * tmc429::clock_prescaler *
                       static_cast<double>(1U << tmc429::Dividers::Pulse::in(word_of<tmc429::Dividers>(world)));
  return register_of<tmc429::ActualVelocity>(world) * tmc429::clock_frequency / ticks;
}

// ---- Rows of a kind

template <unsigned bit>
constexpr Quantity input_row(std::string_view name, std::string_view description) {
  return {.name = name,
          .unit = "",
          .description = description,
          .kind = Kind::truth,
          .highest = 1,
          .read = [](const World& world) { return static_cast<double>(world.inputs() >> bit & 1); },
          .write =
              [](World& world, double value) {
                const std::uint32_t mask = std::uint32_t{1} << bit;
                world.set_inputs(value != 0 ? world.inputs() | mask : world.inputs() & ~mask);
              }};
}

template <unsigned bit>
constexpr Quantity output_row(std::string_view name, std::string_view description) {
  return {.name = name, .unit = "", .description = description, .kind = Kind::truth, .read = [](const World& world) {
            return static_cast<double>(world.outputs() >> bit & 1);
          }};
}

template <unsigned channel>
constexpr Quantity analog_row(std::string_view name, std::string_view description) {
  return {.name = name,
          .unit = "",
          .description = description,
          .kind = Kind::whole,
          .highest = 4095,
          .read = [](const World& world) { return static_cast<double>(world.analog_input(channel)); },
          .write = [](World& world, double value) { world.set_analog_input(channel, rounded(value)); }};
}

template <class Register>
constexpr Quantity register_row(std::string_view name, std::string_view description) {
  return {.name = name, .unit = "", .description = description, .kind = Kind::whole, .read = register_of<Register>};
}

template <class Flag>
constexpr Quantity flag_row(std::string_view name, std::string_view description) {
  return {.name = name, .unit = "", .description = description, .kind = Kind::truth, .read = [](const World& world) {
            return Flag::is_set(world.tmc262().reply()) ? 1.0 : 0.0;
          }};
}

// ---- The tables

constexpr Quantity supply_rows[] = {
    // ---- Supply and surroundings
    {.name = "supply_voltage",
     .unit = "V",
     .description = "Motor supply. Below 7 V the driver loses its registers.",
     .trace_scale = millivolts,
     .highest = 60,
     .read = [](const World& world) { return world.supply_voltage() / millivolts; },
     .write = [](World& world, double value) { world.set_supply_voltage(rounded(value * millivolts)); }},
    {.name = "temperature",
     .unit = "degC",
     .description = "Of the board and the driver. Warning from 100, bridges off from 150.",
     .kind = Kind::whole,
     .trace_scale = 1,
     .lowest = -40,
     .highest = 200,
     .read = [](const World& world) { return static_cast<double>(world.temperature()); },
     .write = [](World& world, double value) { world.set_temperature(rounded(value)); }},
};

constexpr Quantity module_rows[] = {
    // ---- Inputs and outputs
    {.name = "pull_ups",
     .unit = "",
     .description = "The pull-up resistors of the three switch inputs are on.",
     .kind = Kind::truth,
     .read = [](const World& world) { return world.pull_ups() ? 1.0 : 0.0; }},
    input_row<0>("input.0", "Level at general purpose input IN0 (TMCM-1110: AIN_0 as a digital input)."),
    input_row<1>("input.1", "Level at general purpose input IN1."),
    input_row<2>("input.2", "Level at general purpose input IN2."),
    input_row<3>("input.3", "Level at general purpose input IN3."),
    input_row<4>("input.4", "Level at general purpose input IN4."),
    input_row<5>("input.5", "Level at general purpose input IN5."),
    input_row<6>("input.6", "Level at general purpose input IN6."),
    input_row<7>("input.7", "Level at general purpose input IN7."),
    input_row<step_direction_enable_bit>("step_direction.enable", "Level of ENABLE at the step/direction connector."),
    {.name = "step_direction.rate",
     .unit = "1/s",
     .description = "Pulses in a second at STEP of that connector; negative: in the other direction.",
     .lowest = -StepInput::highest_rate,
     .highest = StepInput::highest_rate,
     .read = [](const World& world) { return world.step_input_rate(); },
     .write = [](World& world, double value) { world.set_step_input_rate(value); }},
    {.name = "inputs",
     .unit = "",
     .description = "Levels of all digital inputs as bits: IN0 is bit 0, step_direction.enable bit 11.",
     .kind = Kind::whole,
     .trace_scale = 1,
     .read = [](const World& world) { return static_cast<double>(world.inputs()); }},
    analog_row<0>("analog_input.0", "Converter value of analog input AIN_0."),
    analog_row<1>("analog_input.1", "Converter value of analog input AIN_1."),
    analog_row<2>("analog_input.2", "Converter value of analog input AIN_2."),
    analog_row<3>("analog_input.3", "Converter value of analog input AIN_3."),
    output_row<0>("output.0", "Level of general purpose output OUT0."),
    output_row<1>("output.1", "Level of general purpose output OUT1."),
    output_row<2>("output.2", "Level of general purpose output OUT2."),
    output_row<3>("output.3", "Level of general purpose output OUT3."),
    output_row<4>("output.4", "Level of general purpose output OUT4."),
    output_row<5>("output.5", "Level of general purpose output OUT5."),
    output_row<6>("output.6", "Level of general purpose output OUT6."),
    output_row<7>("output.7", "Level of general purpose output OUT7."),
    {.name = "outputs",
     .unit = "",
     .description =
         "Levels of all digital outputs as bits: OUT0 is bit 0, the pull-ups bit 8, ENN of the driver bit 9.",
     .kind = Kind::whole,
     .trace_scale = 1,
     .read = [](const World& world) { return static_cast<double>(world.outputs()); }},
    // ---- The motion controller
    register_row<tmc429::ActualPosition>("position", "Steps that the TMC429 has given out: X_ACTUAL."),
    register_row<tmc429::TargetPosition>("target_position", "Where the TMC429 drives to: X_TARGET."),
    register_row<tmc429::ActualVelocity>("velocity", "Velocity in the TMC429's unit, -2047 to 2047: V_ACTUAL."),
    register_row<tmc429::TargetVelocity>("target_velocity", "Velocity that the TMC429 changes to: V_TARGET."),
    register_row<tmc429::MaximumVelocity>("maximum_velocity", "Limit of the TMC429's velocity: V_MAX."),
    register_row<tmc429::MaximumAcceleration>("maximum_acceleration",
                                              "Acceleration in the TMC429's unit, 0 to 2047: A_MAX."),
    register_row<tmc429::LatchedPosition>("latched_position", "Position at the last reference switch edge: X_LATCHED."),
    {.name = "step_rate",
     .unit = "1/s",
     .description = "Steps in a second at the present velocity, negative to the left.",
     .read = step_rate},
    {.name = "step",
     .unit = "",
     .description = "Level of the TMC429's STEP line.",
     .kind = Kind::truth,
     .trace_scale = 1,
     .read = [](const World& world) { return world.tmc429().step_pin() ? 1.0 : 0.0; }},
    {.name = "direction",
     .unit = "",
     .description = "Level of the TMC429's DIR line.",
     .kind = Kind::truth,
     .trace_scale = 1,
     .read = [](const World& world) { return world.tmc429().direction_pin() ? 1.0 : 0.0; }},
    {.name = "tmc429.unmodelled_writes",
     .unit = "",
     .description = "Writes to bits that the model of the TMC429 gives no meaning.",
     .kind = Kind::whole,
     .read = [](const World& world) { return static_cast<double>(world.tmc429().unmodelled_writes()); }},
    // ---- The driver
    {.name = "tmc262.microstep_position",
     .unit = "",
     .description = "Place in the sine table, 0 to 1023 for four full steps: MSTEP.",
     .kind = Kind::whole,
     .read = [](const World& world) { return static_cast<double>(world.tmc262().microstep_position()); }},
    {.name = "tmc262.current_scale",
     .unit = "",
     .description = "coolStep lets the coils carry (n + 1) / 32 of the full-scale current: SE, 0 to 31.",
     .kind = Kind::whole,
     .read = [](const World& world) { return static_cast<double>(world.tmc262().current_scale()); }},
    {.name = "tmc262.current_amplitude",
     .unit = "A",
     .description = "Peak of the sine that the coils are to carry, also while the bridges are off.",
     .read = [](const World& world) { return world.tmc262().current_amplitude() / milliamperes; }},
    {.name = "tmc262.bridges_on",
     .unit = "",
     .description = "The driver's bridges can carry current.",
     .kind = Kind::truth,
     .read = [](const World& world) { return world.tmc262().bridges_on() ? 1.0 : 0.0; }},
    {.name = "tmc262.stall_guard_value",
     .unit = "",
     .description = "The latest value of stallGuard2, SGT included: SG, 0 (much load) to 1023.",
     .kind = Kind::whole,
     .read = [](const World& world) { return static_cast<double>(world.tmc262().stall_guard_value()); }},
    {.name = "tmc262.stall_guard_output",
     .unit = "",
     .description = "Level of SG_TST: the last stallGuard2 measurement was 0.",
     .kind = Kind::truth,
     .read = [](const World& world) { return world.stall_guard_output() ? 1.0 : 0.0; }},
    flag_row<tmc262::Reply::OpenLoadA>("tmc262.open_load_a", "The driver misses coil A: OLA."),
    flag_row<tmc262::Reply::OpenLoadB>("tmc262.open_load_b", "The driver misses coil B: OLB."),
    flag_row<tmc262::Reply::ShortToGroundA>("tmc262.short_to_ground_a",
                                            "A short has switched the bridge of coil A off: S2GA."),
    flag_row<tmc262::Reply::ShortToGroundB>("tmc262.short_to_ground_b",
                                            "A short has switched the bridge of coil B off: S2GB."),
    flag_row<tmc262::Reply::OvertemperatureWarning>("tmc262.overtemperature_warning", "The driver is hot: OTPW."),
    flag_row<tmc262::Reply::Overtemperature>("tmc262.overtemperature",
                                             "The driver is too hot and has switched its bridges off: OT."),
    flag_row<tmc262::Reply::Standstill>("tmc262.standstill", "No step has come for 2^20 clocks: STST."),
    {.name = "tmc262.unmodelled_writes",
     .unit = "",
     .description = "Writes to bits that the model of the TMC262 gives no meaning.",
     .kind = Kind::whole,
     .read = [](const World& world) { return static_cast<double>(world.tmc262().unmodelled_writes()); }},
    // ---- The EEPROM
    {.name = "eeprom.busy",
     .unit = "",
     .description = "A page is being written.",
     .kind = Kind::truth,
     .read = [](const World& world) { return world.eeprom_busy() ? 1.0 : 0.0; }},
    {.name = "eeprom.bytes_written",
     .unit = "",
     .description = "Bytes written to the EEPROM so far.",
     .kind = Kind::whole,
     .read = [](const World& world) { return static_cast<double>(world.eeprom().bytes_written()); }},
};

template <std::size_t... sizes>
constexpr auto joined(const Quantity (&... tables)[sizes]) {
  std::array<Quantity, (sizes + ...)> all{};
  std::size_t end = 0;
  const auto append = [&all, &end](const auto& table) {
    for (const Quantity& row : table) all[end++] = row;
  };
  (append(tables), ...);
  return all;
}

constexpr auto rows = joined(supply_rows, motor_rows::rows, machine_rows::rows, module_rows);

constexpr TraceOnlySignal trace_only[] = {
    {"power", "0 when the supply is taken away, 1 when it is back."},
    {"tmc429.datagram", "A datagram of 32 bits that the microcontroller sends to the TMC429."},
    {"tmc262.word", "A word of 20 bits that the microcontroller sends to the TMC262."},
    {"eeprom.write", "A page write to the EEPROM: its address."},
    {"driver_disable", "Level of ENN of the TMC262: high takes the current off the motor."},
};

constexpr bool is_name(std::string_view name) {
  if (name.empty() || name.front() < 'a' || name.front() > 'z') return false;
  char before = '.';
  for (const char letter : name) {
    const bool is_word = (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9');
    const bool is_joint = letter == '_' || letter == '.';
    if (!is_word && !(is_joint && before != '_' && before != '.')) return false;
    before = letter;
  }
  return before != '_' && before != '.';
}

constexpr bool names_are_unique() {
  constexpr std::size_t row_count = std::size(rows);
  const auto name_at = [](std::size_t i) { return i < row_count ? rows[i].name : trace_only[i - row_count].name; };
  for (std::size_t i = 0; i < row_count + std::size(trace_only); ++i) {
    if (!is_name(name_at(i))) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (name_at(i) == name_at(j)) return false;
    }
  }
  return true;
}

constexpr bool ranges_make_sense() {
  for (const Quantity& row : rows) {
    if (row.description.empty() || row.description.back() != '.') return false;
    if (row.lowest > row.highest) return false;
    if (row.kind == Kind::truth && (row.lowest != 0 || (row.highest != 0 && row.highest != 1))) return false;
  }
  return true;
}

static_assert(names_are_unique());
static_assert(ranges_make_sense());

}  // namespace

std::span<const Quantity> quantities() {
  return rows;
}

std::span<const TraceOnlySignal> trace_only_signals() {
  return trace_only;
}

const Quantity* find_quantity(std::string_view name) {
  for (const Quantity& row : rows) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

std::optional<std::string> absence(const Quantity& quantity, const World& world) {
  if (quantity.exists_in(world)) return std::nullopt;
  return quantity.needs_motor && !world.motor() ? "does not exist with an ideal motor"
                                                : "does not exist on this machine";
}

std::optional<std::string> refusal(const Quantity& quantity, const World& world, double value) {
  if (auto reason = absence(quantity, world)) return reason;
  if (!quantity.can_be_written()) return "can only be looked at";
  if (quantity.set_by_motor && world.motor()) return "can only be set with an ideal motor";
  if (!(value >= quantity.lowest && value <= quantity.highest)) {
    const std::string unit = quantity.unit.empty() ? "" : ' ' + std::string(quantity.unit);
    return "goes from " + text_of(quantity.lowest) + " to " + text_of(quantity.highest) + unit;
  }
  if (quantity.kind == Kind::truth && value != 0 && value != 1) return "is 0 or 1";
  if (quantity.kind == Kind::whole && value != std::trunc(value)) return "is a whole number";
  return std::nullopt;
}

std::string text_of(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

}  // namespace opentmcl::twin
