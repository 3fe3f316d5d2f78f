// SPDX-License-Identifier: BSL-1.0
#include "starts_of_fit.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <stdexcept>

#include "nysalt/detail/together.hpp"
#include "nysalt/learning/search.hpp"

namespace nysalt::detail {

void fix(const fit_options& options, Eigen::VectorXd& theta) {
  for (std::size_t k = 0; k < options.fixed.size(); ++k) {
    if (options.fixed[k]) theta[static_cast<Eigen::Index>(k)] = *options.fixed[k];
  }
}

std::vector<named_parameters> starts_of(const run_time_family& family, const fit_options& options,
                                        const std::vector<Eigen::Index>& free) {
  std::vector<named_parameters> starts = family.starts;
  if (options.start) starts = {{"start", *options.start}};
  starts.insert(starts.end(), options.further_starts.begin(), options.further_starts.end());
  for (auto& start : starts) fix(options, start.theta);
  for (int n = 0; n < options.random_starts; ++n) {
    const auto number = static_cast<std::uint64_t>(n);
    starts.push_back({fmt::format("random {}", n + 1),
                      random_start(family, starts.front().theta, free, options.seed, number)});
  }
  return starts;
}

void require_same(const communicator& ranks, const Eigen::VectorXd& theta) {
  if (ranks.is_alone()) return;
  Eigen::VectorXd of_first = theta;
  ranks.broadcast(std::as_writable_bytes(std::span(of_first.data(), static_cast<std::size_t>(theta.size()))),
                  0);
  together(ranks, [&] {
    if (theta == of_first) return;
    throw std::runtime_error(
        fmt::format("learn: rank {} came to other parameters than rank 0: run all on processors of one kind",
                    ranks.rank()));
  });
}

void require_sound(const run_time_family& family, const fit_options& options) {
  if (options.planned_steps < 1) {
    throw std::invalid_argument(
        fmt::format("learn: planned_steps must be at least 1, got {}", options.planned_steps));
  }
  if (options.max_iterations < 0 || options.random_starts < 0) {
    throw std::invalid_argument(
        fmt::format("learn: max_iterations and random_starts must not be negative, got {} and {}",
                    options.max_iterations, options.random_starts));
  }
  const auto count = static_cast<std::size_t>(family.parameters());
  if ((options.start && options.start->size() != family.parameters()) ||
      (!options.fixed.empty() && options.fixed.size() != count)) {
    throw std::invalid_argument(fmt::format(
        "learn: {} has {} parameters, start and fixed values must be as many", family.name, count));
  }
  for (const auto& start : options.further_starts) {
    if (start.theta.size() == family.parameters() && !start.theta.allFinite()) {
      throw std::invalid_argument(fmt::format("learn: the start '{}' is not finite", start.name));
    }
    if (start.theta.size() == family.parameters()) continue;
    throw std::invalid_argument(fmt::format("learn: the start '{}' has {} parameters, {} has {}", start.name,
                                            start.theta.size(), family.name, family.parameters()));
  }
  Eigen::VectorXd first = options.start.value_or(family.starts.front().theta);
  fix(options, first);
  require_in_range(family, first);
}

}  // namespace nysalt::detail
