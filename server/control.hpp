#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "server/json_rpc.hpp"
#include "server/live_simulation.hpp"
#include "server/session.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::server {

/// Who controls a simulation, and hears of the changes it has subscribed to.
class ControlClient {
 public:
  /// @param params of a notification "changed"
  virtual void changed(const nlohmann::ordered_json& params) = 0;

 protected:
  ~ControlClient() = default;
};

/// Carries out the methods of docs/control.md on a simulation that runs.
class Control final : private Watcher {
 public:
  /// All must outlive this.
  Control(Session& session, LiveSimulation& simulation, WallClock clock = std::chrono::steady_clock::now);
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;
  ~Control() { simulation_.set_watcher(nullptr); }

  /// Calls the method `name` of control_methods(); `answer` comes now or, for those that let time pass, later. The
  /// client must forget() itself before it goes away.
  void call(ControlClient& client, const std::string& name, const nlohmann::json& params, const RpcAnswer& answer);
  /// Ends its subscriptions.
  void forget(const ControlClient& client);

  /// Called when the module is another one, after "load".
  void when_loaded(std::function<void()> callback) { loaded_ = std::move(callback); }

  // ---- For the methods

  Session& session() { return session_; }
  LiveSimulation& simulation() { return simulation_; }
  const twin::World& world() { return session_.module().world(); }
  /// The module as it is at this moment of the wall clock.
  void catch_up();
  void run_to(LiveSimulation::Goal goal, std::chrono::milliseconds limit, const RpcAnswer& answer);
  /// `result` with what every result has: the simulated time.
  nlohmann::ordered_json with_time(const nlohmann::ordered_json& result);
  client::Result<void> load(const std::string& path);

  std::uint64_t subscribe(ControlClient& client, std::vector<const twin::Quantity*> quantities, Microseconds every);
  /// @return whether the client had this subscription
  bool unsubscribe(const ControlClient& client, std::uint64_t number);

  /// Of one client together.
  static constexpr std::size_t most_subscriptions = 100;
  std::size_t subscriptions_of(const ControlClient& client) const;

 private:
  struct Subscription {
    ControlClient* client;
    std::vector<const twin::Quantity*> quantities;
    Microseconds every;
    Microseconds next_look;
    std::vector<double> values;  ///< as the client knows them
  };

  Microseconds next_look() const override { return next_look_; }
  void look() override;
  void plan_next_look();

  Session& session_;
  LiveSimulation& simulation_;
  WallClock clock_;
  std::function<void()> loaded_;
  std::map<std::uint64_t, Subscription> subscriptions_;
  std::uint64_t last_subscription_ = 0;
  Microseconds next_look_ = never;
};

/// A quantity's value as JSON: a whole number, a fraction, or true or false.
nlohmann::ordered_json value_of(const twin::Quantity& quantity, const twin::World& world);

}  // namespace opentmcl::server
