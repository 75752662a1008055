#include "apps/tmcl/live_line.hpp"

#include <algorithm>
#include <iterator>

#include "firmware/spec/instructions.hpp"

namespace opentmcl::app {

namespace {

constexpr Command get(AxisParameter parameter) {
  return {static_cast<std::uint8_t>(Opcode::gap), static_cast<std::uint8_t>(parameter), 0, 0};
}

constexpr Command questions[] = {
    get(AxisParameter::actual_position), get(AxisParameter::actual_speed), get(AxisParameter::microstep_resolution),
    get(AxisParameter::pulse_divisor),
    Command{static_cast<std::uint8_t>(Opcode::ggp), static_cast<std::uint8_t>(GlobalParameter::application_status),
            static_cast<std::uint8_t>(Bank::module_settings), 0}};

}  // namespace

void LiveLine::ask() {
  if (asked_) return;
  for (const Command& question : questions) line_.send(encode(Request{1, question}));
  asked_ = true;
}

std::optional<MotionState> LiveLine::take_answers() {
  std::deque<std::uint8_t>& received = line_.received();
  if (!asked_ || received.size() < std::size(questions) * datagram_size) return std::nullopt;
  asked_ = false;
  const auto next_value = [&received] {
    Datagram datagram;
    std::copy_n(received.begin(), datagram_size, datagram.bytes);
    received.erase(received.begin(), received.begin() + datagram_size);
    return decode_reply(datagram).value;
  };
  MotionState state;
  state.position = next_value();
  state.velocity = next_value();
  state.microstep_resolution = next_value();
  state.pulse_divisor = next_value();
  state.program = static_cast<client::ProgramStatus::State>(next_value());
  return state;
}

}  // namespace opentmcl::app
