#include "boards/twin/rs485_bus.hpp"

#include <algorithm>

namespace opentmcl {

namespace {

constexpr twin::Tick ticks_per_second = 1'000'000 * twin::ticks_per_microsecond;

}  // namespace

class Rs485Bus::Node final : public hal::BytePort {
 public:
  explicit Node(Rs485Bus& bus) : bus_(bus) {}
  virtual ~Node() = default;

  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
    const std::size_t count = std::min(capacity, heard.size());
    std::copy_n(heard.begin(), count, buffer);
    heard.erase(heard.begin(), heard.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }

  void write(const std::uint8_t* data, std::size_t length) override {
    to_send.insert(to_send.end(), data, data + length);
    if (!is_sending()) bus_.start_byte(*this, bus_.now_);
  }

  bool is_sending() const { return ends_at != never; }

  std::deque<std::uint8_t> heard;
  std::deque<std::uint8_t> to_send;  ///< begins with the byte on the wires, if there is one
  twin::Tick ends_at = never;        ///< end of that byte

 private:
  Rs485Bus& bus_;
};

Rs485Bus::Rs485Bus(std::uint32_t baud_rate)
    : byte_duration_((ticks_per_second * bits_per_byte + baud_rate / 2) / baud_rate) {}

Rs485Bus::~Rs485Bus() = default;

hal::BytePort& Rs485Bus::connect() {
  nodes_.push_back(std::make_unique<Node>(*this));
  return *nodes_.back();
}

void Rs485Bus::start_byte(Node& node, twin::Tick tick) {
  if (node.to_send.empty()) return;
  node.ends_at = tick + byte_duration_;
  for (const auto& other : nodes_) {
    if (other.get() == &node || !other->is_sending() || other->ends_at <= tick) continue;
    ++collisions_;
    const auto common = static_cast<std::uint8_t>(node.to_send.front() & other->to_send.front());
    node.to_send.front() = common;
    other->to_send.front() = common;
  }
}

void Rs485Bus::end_byte(Node& node) {
  const twin::Tick end = node.ends_at;
  node.ends_at = never;
  for (const auto& other : nodes_) {
    // Whoever stops sending at this very moment was not listening while the byte came.
    if (other.get() != &node && !other->is_sending()) other->heard.push_back(node.to_send.front());
  }
  node.to_send.pop_front();
  start_byte(node, end);
}

Rs485Bus::Node* Rs485Bus::next_to_end() {
  const auto first = std::min_element(nodes_.begin(), nodes_.end(),
                                      [](const auto& a, const auto& b) { return a->ends_at < b->ends_at; });
  return first == nodes_.end() || !(*first)->is_sending() ? nullptr : first->get();
}

twin::Tick Rs485Bus::next_arrival() const {
  twin::Tick next = never;
  for (const auto& node : nodes_) next = std::min(next, node->ends_at);
  return next;
}

bool Rs485Bus::advance_to(twin::Tick tick) {
  bool heard = false;
  for (Node* node = next_to_end(); node != nullptr && node->ends_at <= tick; node = next_to_end()) {
    now_ = node->ends_at;
    end_byte(*node);
    heard = true;
  }
  now_ = std::max(now_, tick);
  return heard;
}

}  // namespace opentmcl
