#include "server/control.hpp"

#include <algorithm>
#include <utility>

#include "server/control_methods.hpp"

namespace opentmcl::server {

using nlohmann::json;
using nlohmann::ordered_json;
using twin::Quantity;

namespace {

const char* describe(LiveSimulation::Outcome outcome) {
  switch (outcome) {
    case LiveSimulation::Outcome::reached:
      return "reached";
    case LiveSimulation::Outcome::nothing_to_do:
      return "nothing to do";
    case LiveSimulation::Outcome::out_of_time:
      return "the limit came first; the simulation is paused where it got";
    case LiveSimulation::Outcome::given_up:
      return "another client paused, resumed or loaded the simulation";
  }
  return "";
}

ordered_json json_of(const Quantity& quantity, double value) {
  switch (quantity.kind) {
    case Quantity::Kind::truth:
      return value != 0;
    case Quantity::Kind::whole:
      return static_cast<std::int64_t>(value);
    case Quantity::Kind::real:
      return value;
  }
  return nullptr;
}

}  // namespace

ordered_json value_of(const Quantity& quantity, const twin::World& world) {
  return json_of(quantity, quantity.read(world));
}

Control::Control(Session& session, LiveSimulation& simulation, WallClock clock)
    : session_(session), simulation_(simulation), clock_(std::move(clock)) {
  simulation_.set_watcher(this);
}

void Control::call(ControlClient& client, const std::string& name, const json& params, const RpcAnswer& answer) {
  const ControlMethod* method = find_control_method(name);
  if (method == nullptr) {
    answer(RpcError{RpcError::method_not_found, "there is no method \"" + name + R"("; "describe" tells them all)"});
    return;
  }
  json named;
  if (const auto error = name_parameters(*method, params, named)) {
    answer(*error);
    return;
  }
  ControlCall call{*this, client, named, answer};
  method->handle(call);
}

void Control::catch_up() {
  simulation_.serve(clock_());
}

ordered_json Control::with_time(const ordered_json& result) {
  ordered_json complete{{"time", session_.module().now()}};
  complete.update(result);
  return complete;
}

void Control::run_to(LiveSimulation::Goal goal, std::chrono::milliseconds limit, const RpcAnswer& answer) {
  if (simulation_.is_running_to_goal()) {
    answer(RpcError{RpcError::busy, "the simulation is still on its way for another request"});
    return;
  }
  const std::uint64_t turns = session_.module().turns();
  simulation_.run_to(goal, limit, [this, answer, turns](LiveSimulation::Outcome outcome) {
    using Outcome = LiveSimulation::Outcome;
    if (outcome == Outcome::out_of_time || outcome == Outcome::given_up) {
      answer(RpcError{outcome == Outcome::out_of_time ? RpcError::timeout : RpcError::busy, describe(outcome)});
      return;
    }
    answer(with_time({{"reached", outcome == Outcome::reached}, {"turns", session_.module().turns() - turns}}));
  });
}

client::Result<void> Control::load(const std::string& path) {
  if (client::Result<void> loaded = session_.load(path); !loaded) return loaded;
  simulation_.carry(session_.module());
  for (auto& [number, subscription] : subscriptions_) subscription.next_look = session_.module().now();
  plan_next_look();
  if (loaded_) loaded_();
  return {};
}

// ---- Subscriptions

std::uint64_t Control::subscribe(ControlClient& client, std::vector<const Quantity*> quantities, Microseconds every) {
  Subscription subscription{&client, std::move(quantities), every, 0, {}};
  const Microseconds now = session_.module().now();
  // On a grid of simulated time, so that the looks do not depend on when somebody subscribed.
  subscription.next_look = (now / every + 1) * every;
  for (const Quantity* quantity : subscription.quantities) subscription.values.push_back(quantity->read(world()));
  subscriptions_.emplace(++last_subscription_, std::move(subscription));
  plan_next_look();
  return last_subscription_;
}

bool Control::unsubscribe(const ControlClient& client, std::uint64_t number) {
  const auto found = subscriptions_.find(number);
  if (found == subscriptions_.end() || found->second.client != &client) return false;
  subscriptions_.erase(found);
  plan_next_look();
  return true;
}

std::size_t Control::subscriptions_of(const ControlClient& client) const {
  return static_cast<std::size_t>(std::count_if(subscriptions_.begin(), subscriptions_.end(),
                                                [&](const auto& entry) { return entry.second.client == &client; }));
}

void Control::forget(const ControlClient& client) {
  std::erase_if(subscriptions_, [&client](const auto& entry) { return entry.second.client == &client; });
  plan_next_look();
}

void Control::plan_next_look() {
  next_look_ = never;
  for (const auto& [number, subscription] : subscriptions_) next_look_ = std::min(next_look_, subscription.next_look);
}

void Control::look() {
  const Microseconds now = session_.module().now();
  for (auto& [number, subscription] : subscriptions_) {
    if (subscription.next_look > now) continue;
    subscription.next_look = (now / subscription.every + 1) * subscription.every;
    ordered_json values = ordered_json::object();
    for (std::size_t i = 0; i < subscription.quantities.size(); ++i) {
      const Quantity& quantity = *subscription.quantities[i];
      const double value = quantity.read(world());
      if (value == subscription.values[i]) continue;
      subscription.values[i] = value;
      values[std::string(quantity.name)] = json_of(quantity, value);
    }
    if (!values.empty()) {
      subscription.client->changed(with_time({{"subscription", number}, {"values", std::move(values)}}));
    }
  }
  plan_next_look();
}

}  // namespace opentmcl::server
