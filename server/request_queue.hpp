#pragma once

#include <cstddef>

namespace opentmcl::server {

/// Requests on their way to a virtual module.
class RequestQueue {
 public:
  /// Requests the firmware has not read yet.
  virtual std::size_t size() const = 0;

 protected:
  ~RequestQueue() = default;
};

}  // namespace opentmcl::server
