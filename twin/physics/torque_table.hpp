// Pull-out torque, load angle and stiffness of an evenly turning motor, over speed and torque.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "twin/physics/averaged_motor.hpp"

namespace opentmcl::twin {

/// Of a motor under fixed electrical conditions. A row for a speed is computed when it is first needed; what is looked
/// up does not depend on what was looked up before.
class TorqueTable {
 public:
  explicit TorqueTable(const ElectricalConditions& conditions) : conditions_(conditions) {}

  /// Distance of rows, electrical turns per second.
  static constexpr double row_distance = 25;
  /// Speeds from here on are beyond every table: 6000 rpm of the shaft.
  static constexpr double highest_speed = 5000;

  struct Point {
    double load_angle;                 ///< radians by which the field leads the rotor
    double stiffness;                  ///< dT / d(load angle), N m per electrical radian
    double pull_out_torque;            ///< N m, the most the motor gives at this speed
    double pull_out_angle;             ///< radians
    bool saturated;                    ///< the supply does not drive the currents that the regulator asks for
    AveragedMotor::Response response;  ///< meaningful when saturated
  };

  /// @param speed   electrical turns per second, either way, below highest_speed
  /// @param torque  N m on the load, positive against positive motion; limited to the pull-out torque
  Point at(double speed, double torque) const;

  /// N m. @param speed as above
  double pull_out_torque(double speed) const;

  const ElectricalConditions& conditions() const { return conditions_; }

 private:
  static constexpr std::size_t torque_count = 33;

  /// Torques of a row run from -pull-out to +pull-out in even distances.
  struct Row {
    double pull_out_torque;
    double pull_out_angle;
    bool saturates;  ///< at any of the torques
    struct Entry {
      double load_angle;
      double stiffness;
      double modulation;
      AveragedMotor::Response response;
    };
    std::vector<Entry> entries;  ///< none for a row that does not saturate: there T = pull-out sin(load angle)
  };

  const Row& row(std::size_t index) const;
  Row computed_row(std::size_t index) const;

  ElectricalConditions conditions_;
  mutable std::vector<std::unique_ptr<const Row>> rows_;
};

/// The tables of all motors of a process, each made when first asked for. Conditions are rounded, so that a supply that
/// ripples and a winding that warms do not ask for a new table all the time; the same conditions always give the same
/// table.
class TorqueTables {
 public:
  /// Conditions, rounded: two with equal keys have one table. Whole numbers.
  struct Key {
    double quarter_volts;  ///< of the supply, at least 1
    double milliamperes;   ///< amplitude
    double ten_kelvins;    ///< by which the winding is warmer than 20 °C
    friend bool operator==(const Key&, const Key&) = default;
  };
  /// @param supply V  @param amplitude A  @param winding_temperature °C
  static Key key(double supply, double amplitude, double winding_temperature);

  std::shared_ptr<const TorqueTable> table(const MotorData& motor, const Key& key);

  std::size_t size() const { return tables_.size(); }

 private:
  /// More tables than a module's 32 currents at a few temperatures need. When there are more, those nobody uses go.
  static constexpr std::size_t most_tables = 256;

  std::map<std::array<double, 5>, std::shared_ptr<const TorqueTable>> tables_;
};

/// Resistance of a winding of copper. @param resistance at 20 °C
double warm_resistance(double resistance, double temperature);

}  // namespace opentmcl::twin
