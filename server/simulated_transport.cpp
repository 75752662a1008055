#include "server/simulated_transport.hpp"

#include <algorithm>
#include <vector>

namespace opentmcl::server {

struct SimulatedTransport::Bench {
  explicit Bench(const ModuleDescription& description)
      : module(description, std::vector<hal::Port>{{&line.port(), hal::PortKind::usb}}) {}

  MemoryLine line;
  VirtualModule module;
};

SimulatedTransport::SimulatedTransport(const ModuleDescription& description)
    : bench_(std::make_unique<Bench>(description)),
      module_(bench_->module),
      line_(bench_->line),
      name_(std::string("sim:") + description.argument) {}

SimulatedTransport::SimulatedTransport(Simulated& module, MemoryLine& line, std::string name)
    : module_(module), line_(line), name_(std::move(name)) {}

SimulatedTransport::~SimulatedTransport() = default;

client::Result<void> SimulatedTransport::send(std::span<const std::uint8_t> bytes) {
  cutter_.take(bytes, module_.now(), line_.port(), line_);
  return {};
}

void SimulatedTransport::take_turn() {
  module_.wake();
  module_.advance_to(module_.now());
  cutter_.take_rest(line_.port(), line_);
}

client::Result<std::size_t> SimulatedTransport::receive(std::span<std::uint8_t> buffer, client::Duration limit) {
  const Microseconds deadline = module_.now() + static_cast<Microseconds>(std::max(limit, client::Duration(0)).count());
  std::vector<std::uint8_t>& received = line_.received();
  // A turn that takes no request may still prepare for the next one, as the first after power-on does.
  constexpr int most_vain_turns = 2;
  for (int turn = 0; turn < most_vain_turns && received.empty() && line_.port().size() > 0; ++turn) take_turn();
  while (received.empty() && module_.now() < deadline) {
    // While the firmware is busy it is asked again and again, else it says when something happens.
    const Microseconds next = line_.port().size() > 0 ? module_.now() + one_millisecond : module_.next_turn();
    module_.advance_to(std::clamp(next, module_.now() + 1, deadline));
    if (line_.port().size() > 0) take_turn();
  }
  const std::size_t count = std::min(buffer.size(), received.size());
  std::copy_n(received.begin(), count, buffer.begin());
  received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

void SimulatedTransport::pause(client::Duration duration) {
  module_.advance_to(module_.now() + static_cast<Microseconds>(duration.count()));
}

client::Duration SimulatedTransport::now() const {
  return client::Duration(module_.now());
}

}  // namespace opentmcl::server
