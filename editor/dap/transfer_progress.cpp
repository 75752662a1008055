#include "editor/dap/transfer_progress.hpp"

#include <utility>

namespace opentmcl::editor::dap {

TransferProgress::TransferProgress(Outbox& outbox, const ClientConventions& client, std::string id, std::string title)
    : outbox_(outbox), is_wanted_(client.knows_progress), id_(std::move(id)), title_(std::move(title)) {}

TransferProgress::~TransferProgress() {
  if (has_begun_) outbox_.tell("progressEnd", {{"progressId", id_}});
}

void TransferProgress::show(std::size_t done, std::size_t total) {
  if (!is_wanted_ || total == 0) return;
  const std::size_t percentage = done * 100 / total;
  const std::string message = std::to_string(done) + " of " + std::to_string(total) + " instructions";
  if (!has_begun_) {
    has_begun_ = true;
    outbox_.tell("progressStart", {{"progressId", id_},
                                   {"title", title_},
                                   {"message", message},
                                   {"percentage", percentage},
                                   {"cancellable", true}});
  } else if (percentage != shown_percentage_) {
    outbox_.tell("progressUpdate", {{"progressId", id_}, {"message", message}, {"percentage", percentage}});
  }
  shown_percentage_ = percentage;
}

}  // namespace opentmcl::editor::dap
