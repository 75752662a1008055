#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "editor/dap/protocol.hpp"

namespace opentmcl::editor::dap {

/// Shows a client that wants to know how far a transfer is.
class TransferProgress {
 public:
  /// `outbox` must outlive this.
  TransferProgress(Outbox& outbox, const ClientConventions& client, std::string id, std::string title);
  TransferProgress(const TransferProgress&) = delete;
  TransferProgress& operator=(const TransferProgress&) = delete;
  ~TransferProgress();

  const std::string& id() const { return id_; }
  /// A message for each percent at most.
  void show(std::size_t done, std::size_t total);

 private:
  Outbox& outbox_;
  bool is_wanted_;
  std::string id_;
  std::string title_;
  bool has_begun_ = false;
  std::size_t shown_percentage_ = 0;
};

}  // namespace opentmcl::editor::dap
