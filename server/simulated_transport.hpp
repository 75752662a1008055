#pragma once

#include <memory>
#include <string>

#include "boards/twin/virtual_module.hpp"
#include "client/transport.hpp"
#include "server/memory_line.hpp"
#include "server/request_cutter.hpp"

namespace opentmcl::server {

/// A virtual module in the same process. Its time passes only while somebody waits for it, and then as fast as it can:
/// a limit or a pause is a limit or a pause of the module's own time, and every run is the same.
class SimulatedTransport final : public client::Transport {
 public:
  /// A module of its own, fresh from the factory.
  explicit SimulatedTransport(const ModuleDescription& description);
  /// A module that others use too, or the line that it is on; both must outlive this. `line`'s port must be one of the
  /// module's.
  SimulatedTransport(Simulated& module, MemoryLine& line, std::string name);
  ~SimulatedTransport() override;

  client::Result<void> send(std::span<const std::uint8_t> bytes) override;
  client::Result<std::size_t> receive(std::span<std::uint8_t> buffer, client::Duration limit) override;
  void drain() override { line_.received().clear(); }
  void pause(client::Duration duration) override;
  client::Duration now() const override;
  const std::string& name() const override { return name_; }

 private:
  struct Bench;

  void take_turn();

  std::unique_ptr<Bench> bench_;  // none when others own the module
  Simulated& module_;
  MemoryLine& line_;
  std::string name_;
  RequestCutter cutter_;
};

}  // namespace opentmcl::server
