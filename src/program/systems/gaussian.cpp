// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/gaussian.hpp"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

namespace {

/// Quantiles of log omega = log(condition)/2 (u - 1/2) + deviation z with u and z uniform and normal.
Eigen::VectorXd frequencies_of(Eigen::Index size, double condition, double deviation) {
  Eigen::VectorXd result(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(size);
    const double z = std::numbers::sqrt2 * boost::math::erf_inv(2.0 * u - 1.0);
    result[i] = std::exp(0.5 * std::log(condition) * (u - 0.5) + deviation * z);
  }
  return result;
}

}  // namespace

system_declaration declare_gaussian() {
  system_declaration result{.name = "gaussian",
                            .title = "independent oscillators around the frequency 1, for sampling"};
  result.parameters = {{.name = "size",
                        .usual = 100,
                        .meaning = "number of coordinates",
                        .least = 1,
                        .most = 10'000'000},  // a state of some hundred megabytes
                       {.name = "condition",
                        .usual = 1.0,
                        .meaning = "largest variance over the smallest, frequencies log-uniform",
                        .least = 1.0},
                       {.name = "deviation",
                        .usual = 0.0,
                        .meaning = "standard deviation of a normal part of log omega",
                        .least = 0.0,
                        .most = 10.0}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    const auto size = values.whole("size");
    const gaussian system(frequencies_of(size, values.real("condition"), values.real("deviation")));
    const double fastest = system.frequency_bands().back().high;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(size);
    const normal_around<Eigen::Dynamic> law({rest, rest}, spread / fastest, spread);
    return detail::made_of(system, in, law, fastest);
  };
  return result;
}

}  // namespace nysalt::program
