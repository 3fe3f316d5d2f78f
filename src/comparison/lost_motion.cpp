// SPDX-License-Identifier: BSL-1.0
#include "lost_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "nysalt/energy.hpp"
#include "nysalt/integrate_ensemble.hpp"

namespace nysalt::program {

namespace {

using column = Eigen::VectorXd;

/// Of each coordinate, over some starts.
struct motions {
  explicit motions(Eigen::Index n)
      : kinetic(column::Zero(n)), change(column::Zero(n)), q(column::Zero(n)), is_moved(column::Zero(n)) {}

  double most = 0.0;  // the largest |p v| of all, also after a kick
  column kinetic;     // the largest |p v|
  column change;      // the largest |h v|
  column q;           // where that is
  column is_moved;    // 1 if q + h v differs from q at a start
};

motions motions_at_starts(const prepared_problem& system, const trajectories_plan& plan) {
  const model dynamics = own_copy(system.definition().system);
  const Eigen::Index n = dynamics.size();
  const std::int64_t starts = std::clamp<std::int64_t>(100'000 / n, 1, 16);
  motions found(n);
  phase_point<double, Eigen::Dynamic> x{column(n), column(n)};
  column f(n), v(n), kicked(n);
  for (std::int64_t m = 0; m < std::min(starts, plan.count); ++m) {
    system.start_state(plan.seed, static_cast<std::uint64_t>(m), {x.q.data(), static_cast<std::size_t>(n)},
                       {x.p.data(), static_cast<std::size_t>(n)});
    dynamics.force(x.q, f);
    velocity<double>(dynamics, x.p, v);
    const column kicked_p = x.p + plan.step * f;
    velocity<double>(dynamics, kicked_p, kicked);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double change = plan.step * std::max(std::abs(v[i]), std::abs(kicked[i]));
      found.kinetic[i] = std::max(found.kinetic[i], std::abs(x.p[i] * v[i]));
      found.most = std::max({found.most, found.kinetic[i], std::abs(kicked_p[i] * kicked[i])});
      // Also where a velocity is not finite.
      if (!(x.q[i] + change == x.q[i] && x.q[i] - change == x.q[i])) found.is_moved[i] = 1.0;
      if (change <= found.change[i]) continue;
      found.change[i] = change;
      found.q[i] = x.q[i];
    }
  }
  return found;
}

}  // namespace

std::optional<std::string> warning_of_lost_motion(const prepared_problem& system,
                                                  const trajectories_plan& plan) {
  const motions found = motions_at_starts(system, plan);
  const double least = std::numeric_limits<double>::epsilon() * found.most;
  std::optional<Eigen::Index> first;
  std::int64_t count = 0;
  for (Eigen::Index i = 0; i < found.q.size(); ++i) {
    if (found.is_moved[i] != 0.0 || !(found.kinetic[i] > 0.0 && found.kinetic[i] >= least)) continue;
    if (!first) first = i;
    ++count;
  }
  if (!first) return std::nullopt;
  const double q = std::abs(found.q[*first]);
  const double change = found.change[*first];
  const double apart = std::nextafter(q, std::numeric_limits<double>::infinity()) - q;
  const std::string which = count > 1 ? fmt::format("{} coordinates (the first is q{})", count, *first + 1)
                                      : fmt::format("q{}", *first + 1);
  return fmt::format(
      "at step {:g} the motion of {} is lost in rounding: a step changes q{} by {:.2g}, and doubles near "
      "{:.6g} are {:.2g} apart; put the origin near the motion, or take steps far above {:.2g}",
      plan.step, which, *first + 1, change, found.q[*first], apart, plan.step * apart / (2.0 * change));
}

}  // namespace nysalt::program
