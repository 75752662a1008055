#include "twin/physics/torque_table.hpp"

#include <algorithm>
#include <cmath>

namespace opentmcl::twin {
namespace {

// Load angles a row is computed at, radians. A motor that turns fast gives its most beyond a quarter turn.
constexpr double lowest_angle = -std::numbers::pi / 2;
constexpr double highest_angle = std::numbers::pi;
constexpr std::size_t angle_count = 181;
constexpr double angle_distance = (highest_angle - lowest_angle) / (angle_count - 1);

/// From here on a chopper's voltage is no longer seen as free of limits: ripple takes the rest.
constexpr double saturation = 0.95;

/// Of the pull-out torque; at the top of the curve there is none.
constexpr double least_stiffness = 1e-4;

double angle_at(std::size_t index) {
  return lowest_angle + static_cast<double>(index) * angle_distance;
}

double between(double first, double second, double share) {
  return first + share * (second - first);
}

AveragedMotor::Response between(const AveragedMotor::Response& first, const AveragedMotor::Response& second,
                                double share) {
  return {between(first.e1, second.e1, share), between(first.e0, second.e0, share),
          between(first.w1, second.w1, share), between(first.w0, second.w0, share),
          between(first.d1, second.d1, share), between(first.d0, second.d0, share)};
}

}  // namespace

TorqueTable::Row TorqueTable::computed_row(std::size_t index) const {
  const double speed = static_cast<double>(index) * row_distance * radians_per_turn;
  const AveragedMotor motor(conditions_, speed);
  std::array<double, angle_count> torques{};
  bool saturates = false;
  for (std::size_t i = 0; i < angle_count; ++i) {
    const AveragedMotor::OperatingPoint point = motor.at(angle_at(i));
    torques[i] = point.torque;
    saturates = saturates || (point.modulation > saturation && angle_at(i) < std::numbers::pi / 2);
  }
  if (!saturates) {
    return {conditions_.torque_constant * conditions_.amplitude, std::numbers::pi / 2, false, {}};
  }

  const auto best = static_cast<std::size_t>(std::max_element(torques.begin(), torques.end() - 1) - torques.begin());
  const auto worst = static_cast<std::size_t>(
      std::min_element(torques.begin(), torques.begin() + static_cast<std::ptrdiff_t>(best) + 1) - torques.begin());
  // Between the samples the top is a parabola.
  double top = 0;
  double top_torque = torques[best];
  if (best > 0) {
    const double slope = (torques[best + 1] - torques[best - 1]) / 2;
    const double curvature = torques[best + 1] - 2 * torques[best] + torques[best - 1];
    if (curvature < 0) {
      top = std::clamp(-slope / curvature, -0.5, 0.5);
      top_torque += top * (slope + 0.5 * curvature * top);
    }
  }
  // A motor that is dragged far beyond its speed only brakes: a torque of nothing then keeps everything else finite.
  top_torque = std::max(top_torque, 1e-6 * conditions_.torque_constant * conditions_.amplitude);
  Row result{top_torque, angle_at(best) + top * angle_distance, true, {}};
  result.entries.reserve(torque_count);
  std::size_t i = worst;
  for (std::size_t j = 0; j < torque_count; ++j) {
    const double torque = (-1 + 2 * static_cast<double>(j) / (torque_count - 1)) * top_torque;
    while (i + 1 < best && torques[i + 1] < torque) ++i;
    const double step = best > worst ? torques[i + 1] - torques[i] : 0;
    const double share = step > 0 ? std::clamp((torque - torques[i]) / step, 0.0, 1.0) : 0;
    const double angle = angle_at(i) + share * angle_distance;
    const AveragedMotor::OperatingPoint point = motor.at(angle);
    result.entries.push_back({angle, step / angle_distance, point.modulation, motor.response(point, angle)});
  }
  return result;
}

const TorqueTable::Row& TorqueTable::row(std::size_t index) const {
  if (index >= rows_.size()) rows_.resize(index + 1);
  if (!rows_[index]) rows_[index] = std::make_unique<const Row>(computed_row(index));
  return *rows_[index];
}

double TorqueTable::pull_out_torque(double speed) const {
  const double place = std::fabs(speed) / row_distance;
  const auto index = static_cast<std::size_t>(place);
  return between(row(index).pull_out_torque, row(index + 1).pull_out_torque, place - static_cast<double>(index));
}

TorqueTable::Point TorqueTable::at(double speed, double torque) const {
  const double place = std::fabs(speed) / row_distance;
  const auto index = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(index);
  const Row& below = row(index);
  const Row& above = row(index + 1);

  Point result{};
  result.pull_out_torque = between(below.pull_out_torque, above.pull_out_torque, share);
  result.pull_out_angle = between(below.pull_out_angle, above.pull_out_angle, share);
  // The table is for positive speeds; the other way everything is mirrored.
  const double sign = speed < 0 ? -1 : 1;
  const double ratio = std::clamp(sign * torque / result.pull_out_torque, -1.0, 1.0);

  if (!below.saturates && !above.saturates) {
    // T = T_max sin d
    const double cosine = std::sqrt(1 - ratio * ratio);
    result.load_angle = sign * angle_in_turns({cosine, ratio}) * radians_per_turn;
    result.stiffness = std::max(cosine, least_stiffness) * result.pull_out_torque;
    return result;
  }

  const auto add = [&](const Row& part, double weight) {
    if (!part.saturates) {
      // T = T_max sin d
      const double cosine = std::sqrt(1 - ratio * ratio);
      result.load_angle += weight * angle_in_turns({cosine, ratio}) * radians_per_turn;
      result.stiffness += weight * part.pull_out_torque * cosine;
      return;
    }
    const double column = (ratio + 1) * 0.5 * (torque_count - 1);
    const std::size_t left = std::min(static_cast<std::size_t>(column), torque_count - 2);
    const double right_share = column - static_cast<double>(left);
    const Row::Entry& first = part.entries[left];
    const Row::Entry& second = part.entries[left + 1];
    result.load_angle += weight * between(first.load_angle, second.load_angle, right_share);
    result.stiffness += weight * between(first.stiffness, second.stiffness, right_share);
    if (std::max(first.modulation, second.modulation) > saturation) {
      result.saturated = true;
      result.response = between(first.response, second.response, right_share);
    }
  };
  // The row that weighs more comes last: its response is the one that stays.
  if (share < 0.5) {
    add(above, share);
    add(below, 1 - share);
  } else {
    add(below, 1 - share);
    add(above, share);
  }
  result.load_angle *= sign;
  result.stiffness = std::max(result.stiffness, least_stiffness * result.pull_out_torque);
  return result;
}

TorqueTables::Key TorqueTables::key(double supply, double amplitude, double winding_temperature) {
  return {std::max(1.0, nearest_integer(supply * 4)), nearest_integer(amplitude * 1000),
          nearest_integer((winding_temperature - 20) * 0.1)};
}

std::shared_ptr<const TorqueTable> TorqueTables::table(const MotorData& motor, const Key& key) {
  const ElectricalConditions conditions{
      .torque_constant = motor.torque_constant(),
      .inductance = motor.winding_inductance,
      .resistance = warm_resistance(motor.winding_resistance, 20 + 10 * key.ten_kelvins),
      .supply = key.quarter_volts / 4,
      .amplitude = key.milliamperes / 1000,
  };
  const std::array<double, 5> place{conditions.torque_constant, conditions.inductance, conditions.resistance,
                                    conditions.supply, conditions.amplitude};
  if (const auto found = tables_.find(place); found != tables_.end()) return found->second;
  if (tables_.size() >= most_tables)
    std::erase_if(tables_, [](const auto& entry) { return entry.second.use_count() == 1; });
  return tables_.emplace(place, std::make_shared<const TorqueTable>(conditions)).first->second;
}

double warm_resistance(double resistance, double temperature) {
  constexpr double copper_per_kelvin = 0.00393;
  return resistance * (1 + copper_per_kelvin * (temperature - 20));
}

}  // namespace opentmcl::twin
