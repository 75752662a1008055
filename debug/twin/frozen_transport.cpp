#include "debug/twin/frozen_transport.hpp"

#include <algorithm>

namespace opentmcl::debug {

using client::Duration;
using client::Error;
using client::ErrorKind;
using client::Result;

Result<void> FrozenTransport::send(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != datagram_size) return Error{ErrorKind::internal, "a request has nine bytes", {}};
  Datagram request;
  std::copy(bytes.begin(), bytes.end(), request.bytes);
  const Result<std::optional<Datagram>> reply = module_.answer(request);
  if (!reply) return reply.error();
  if (*reply) received_.insert(received_.end(), std::begin((*reply)->bytes), std::end((*reply)->bytes));
  return {};
}

Result<std::size_t> FrozenTransport::receive(std::span<std::uint8_t> buffer, Duration limit) {
  const std::size_t count = std::min(buffer.size(), received_.size());
  if (count == 0) waited_ += std::max(limit, Duration(0));
  std::copy_n(received_.begin(), count, buffer.begin());
  received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

}  // namespace opentmcl::debug
