// Compares the regimes with full integration over 2 x 600 random moves and prints the figures of docs/performance.md:
// regime_comparison [moves of each kind]

#include "twin/physics/regime_comparison.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

namespace {

using namespace opentmcl::twin;

/// @param values in any order, not none
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void compare(double highest_rpm, int count) {
  const auto tables = std::make_shared<TorqueTables>();
  RandomMoves moves(1, highest_rpm);
  int both = 0;
  int neither = 0;
  int disagree = 0;
  int late = 0;
  std::vector<double> time_differences;  // ms
  std::vector<double> lead_differences;  // degrees
  double integrated_share = 0;
  double fast_seconds = 0;
  double full_seconds = 0;
  for (int i = 0; i < count; ++i) {
    const ComparedMove move = moves.next(*tables);
    const double begin = processor_seconds();
    const MoveResult fast = result_of(move, tables, false);
    const double middle = processor_seconds();
    const MoveResult full = result_of(move, tables, true);
    fast_seconds += middle - begin;
    full_seconds += processor_seconds() - middle;
    integrated_share += fast.integrated_share / count;
    if (fast.stall_time.has_value() != full.stall_time.has_value()) {
      ++disagree;
    } else if (fast.stall_time) {
      ++both;
      time_differences.push_back(std::fabs(*fast.stall_time - *full.stall_time) * 1e3);
      late += time_differences.back() > 20 ? 1 : 0;
    } else {
      ++neither;
      lead_differences.push_back(std::fabs(fast.mean_lead - full.mean_lead) * 360);
    }
  }
  std::printf("up to %.0f rpm: both stall %d, neither %d, disagree %d\n", highest_rpm, both, neither, disagree);
  if (!time_differences.empty()) {
    std::printf("  stall time difference: median %.1f ms, 95 %% %.1f ms, largest %.1f ms, %d above 20 ms\n",
                quantile(time_differences, 0.5), quantile(time_differences, 0.95), quantile(time_differences, 1), late);
  }
  if (!lead_differences.empty()) {
    std::printf("  mean lead difference: median %.3f deg, 95 %% %.2f deg, largest %.2f deg\n",
                quantile(lead_differences, 0.5), quantile(lead_differences, 0.95), quantile(lead_differences, 1));
  }
  std::printf("  integrated %.0f %% of the time, %.1f s of processor time against %.1f s\n", 100 * integrated_share,
              fast_seconds, full_seconds);
}

}  // namespace

int main(int argc, char** argv) {
  int count = 600;
  if (argc > 2 ||
      (argc == 2 && (std::from_chars(argv[1], argv[1] + std::strlen(argv[1]), count).ec != std::errc{} || count < 1))) {
    std::fputs("usage: regime_comparison [moves of each kind]\n", stderr);
    return 64;
  }
  compare(293, count);
  compare(586, count);
  return 0;
}
