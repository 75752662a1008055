#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/transport.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::debug {

/// A connection to a module that answers at once: no time of the module passes for it.
class FrozenTransport final : public client::Transport {
 public:
  /// The other end.
  class Module {
   public:
    /// Nothing: it has no reply to that. Error: refused, when it could only answer later.
    virtual client::Result<std::optional<Datagram>> answer(const Datagram& request) = 0;
    virtual Microseconds time() const = 0;
    virtual void let_pass(Microseconds duration) = 0;

   protected:
    ~Module() = default;
  };

  /// `module` must outlive this.
  FrozenTransport(Module& module, std::string name) : module_(module), name_(std::move(name)) {}

  /// @param bytes one request; whoever sends a part of one is no Client
  client::Result<void> send(std::span<const std::uint8_t> bytes) override;
  client::Result<std::size_t> receive(std::span<std::uint8_t> buffer, client::Duration limit) override;
  void drain() override { received_.clear(); }
  void pause(client::Duration duration) override { module_.let_pass(static_cast<Microseconds>(duration.count())); }
  /// The module's time, and what was waited for in vain.
  client::Duration now() const override { return client::Duration(module_.time()) + waited_; }
  const std::string& name() const override { return name_; }

 private:
  Module& module_;
  std::string name_;
  std::vector<std::uint8_t> received_;
  client::Duration waited_{0};
};

}  // namespace opentmcl::debug
