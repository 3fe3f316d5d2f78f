// SPDX-License-Identifier: BSL-1.0
// Your own observable and your own observer.
//
// An observable is a function of a state. The distance of a planet from its sun, averaged over times and over
// a thousand ellipses of eccentricity e, is 1 + e^2/2 of the semi-major axis: we must find that. An observer
// is called along one trajectory and may remember: ours waits for the planet to come near, and notes in which
// direction that happens. It should be the same each time; what it turns by is the method's doing.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [observable]
const auto distance = over_lanes([](const auto& x) {  // many trajectories at a time
  using std::sqrt;
  return sqrt(x.q[0] * x.q[0] + x.q[1] * x.q[1]);
});
// [/observable]

// [observer]
/// Notes the direction of the planet each time that it is nearest: where q . p turns from minus to plus.
struct pericentres {
  std::vector<double> angles;
  phase_point<double, 2> last{{0.0, 0.0}, {0.0, 0.0}};

  void operator()(std::int64_t n, double, const phase_point<double, 2>& x) {
    const double before = last.q.dot(last.p);
    const double now = x.q.dot(x.p);
    if (n > 0 && before < 0.0 && now >= 0.0) {
      const double part = before / (before - now);  // of the step, on a straight line
      const vector<double, 2> nearest = last.q + part * (x.q - last.q);
      angles.push_back(std::atan2(nearest[1], nearest[0]));
    }
    last = x;
  }
};
// [/observer]

int main() {
  constexpr double eccentricity = 0.5;
  const kepler system;
  const kepler_law ellipses(eccentricity);

  // [ensemble]
  std::vector<double> mean_of_each(1000, 0.0);
  const auto add = [&](std::int64_t m, std::int64_t n, double r) {
    if (n > 0) mean_of_each[static_cast<std::size_t>(m)] += r / 100;
  };
  const ensemble_options options{
      .trajectories = 1000, .steps = 1000, .every = 10, .seed = 1, .execution = {.threads = 2}};
  integrate_ensemble(system, pefrl{}, 0.05, ellipses, options, distance, add);
  const auto [mean, error] = mean_and_error(mean_of_each);
  // [/ensemble]
  fmt::print("mean distance {:.4f} +- {:.4f}, and 1 + e^2/2 = {:.4f}\n", mean, error,
             1.0 + 0.5 * eccentricity * eccentricity);

  // [along]
  const phase_point<double, 2> farthest{{-1.5, 0.0}, {0.0, -std::sqrt(1.0 / 3.0)}};
  const auto report = [&](const method& method, double step) {
    pericentres seen;
    integrate(system, method, step, farthest, std::llround(200.0 / step), seen);
    const double turned = seen.angles.back() - seen.angles.front();
    fmt::print("{:<10} {} times near, and each time turned by {:+.6f}\n", method.name(), seen.angles.size(),
               turned / static_cast<double>(seen.angles.size() - 1));
  };
  report(verlet{}, 0.01);
  report(pefrl{}, 0.04);  // the same cost: four evaluations a step
  // [/along]
}

// Expected output:
// mean distance 1.1251 +- 0.0001, and 1 + e^2/2 = 1.1250
// verlet     32 times near, and each time turned by -0.000395
// pefrl      32 times near, and each time turned by -0.000005
