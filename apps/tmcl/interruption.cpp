#include "apps/tmcl/interruption.hpp"

#include <csignal>

namespace opentmcl::app {

namespace {

// A signal handler has nothing but globals to write to.
volatile std::sig_atomic_t interruption_requested = 0;

void request_interruption(int) {
  interruption_requested = 1;
}

}  // namespace

Interruption::Interruption() {
  interruption_requested = 0;
  std::signal(SIGINT, request_interruption);
  std::signal(SIGTERM, request_interruption);
}

Interruption::~Interruption() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool Interruption::requested() const {
  return interruption_requested != 0;
}

bool Interruption::take() const {
  if (interruption_requested == 0) return false;
  interruption_requested = 0;
  return true;
}

}  // namespace opentmcl::app
