// SPDX-License-Identifier: BSL-1.0
// Your own loss: learn what you care for.
//
// The ellipse of a planet should not turn. Its direction is that of the vector of Laplace, Runge and Lenz,
// A = p x L - q/|q|, which the motion conserves and a method does not. So we do not ask for the least error
// of a step, which is the loss of the library, but for the least change of A in a revolution of 24 steps. A
// loss is a name, a number of steps, and a function that says what the residuals after that number of steps
// are. One direction is one condition: of the family's two parameters we keep Chin's b = 1/6, and learn c.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

constexpr int steps_of_revolution = 24;
const fg_chin chin;  // B(b) A(1/2) G(1 - 2 b, c) A(1/2) B(b), three evaluations

// [loss]
template <Scalar T>
vector<T, 2> laplace_vector(const phase_point<T, 2>& x) {
  using std::sqrt;
  const T momentum = x.q[0] * x.p[1] - x.q[1] * x.p[0];
  const T r = sqrt(x.q[0] * x.q[0] + x.q[1] * x.q[1]);
  return vector<T, 2>(x.p[1] * momentum - x.q[0] / r, -x.p[0] * momentum - x.q[1] / r);
}

/// By how much A changes in a revolution. Where the planet is then, which the data know, is not asked.
const own_loss turning{"turning", steps_of_revolution,
                       []<class T>(const phase_point<T, 2>& start, const phase_point<T, 2>& finish,
                                   const phase_point<T, 2>& /* wanted */) -> vector<T, 2> {
                         return laplace_vector(finish) - laplace_vector(start);
                       }};
// [/loss]

int main() {
  const kepler system;
  const kepler_law ellipses(0.3);
  constexpr double step = 2.0 * std::numbers::pi / steps_of_revolution;
  const auto reference = fine_steps(step / 20);
  const auto revolutions = [&](std::uint64_t seed) {
    return make_flow_map_data(system, ellipses, reference,
                              {.step = step, .horizon = 2.0 * std::numbers::pi, .seed = seed});
  };
  const auto data = revolutions(1);
  const auto unseen = revolutions(2);

  // [learn]
  const fit_options options{.fixed = {1.0 / 6.0, std::nullopt}};
  const auto usual = learn(chin, system, data, unseen, options);  // the error of the state
  const auto own = learn(chin, system, data, unseen, options, turning);
  // [/learn]

  const auto report = [](const char* name, const fit& found) {
    const auto& p = found.summary.parameters[1];
    fmt::print("{}: {} = {:.6f} +- {:.0e}, usable: {}\n", name, p.name, p.value, p.standard_error,
               found.summary.usable ? "yes" : found.summary.reason);
  };
  report("the error of the state", usual);
  report("the turning", own);

  // Along a hundred revolutions, on ellipses that were not learned from, at equal cost.
  const auto follow = [&](const char* name, const method& method, double method_step) {
    const auto steps = std::llround(200.0 * std::numbers::pi / method_step);
    std::vector<double> angles;
    std::vector<double> distances;
    for (std::uint64_t n = 0; n < 50; ++n) {
      const auto start = ellipses(3, n);
      const auto end = integrate(system, method, method_step, start, steps).finish;
      const auto before = laplace_vector(start);
      const auto after = laplace_vector(end);
      angles.push_back(std::atan2(before[0] * after[1] - before[1] * after[0], before.dot(after)));
      distances.push_back((end.q - start.q).norm());  // exactly 0 after whole revolutions without error
    }
    const auto turned = mean_and_error(angles);
    fmt::print("{:<16} {:+.5f} +- {:.5f}   {:.3f}\n", name, turned.mean, turned.standard_error,
               mean_and_error(distances).mean);
  };
  fmt::print("\nafter a hundred revolutions the ellipse has turned by, and the planet is off by\n");
  follow("error of the state", usual.method.anywhere(), step);
  follow("turning", own.method.anywhere(), step);
  follow("chin4a", chin4a{}, step);
  follow("pefrl", pefrl{}, step * 4 / 3);
  follow("verlet", verlet{}, step / 3);
}

// Expected output:
// the error of the state: c = 0.014237 +- 1e-05, usable: yes
// the turning: c = 0.014573 +- 6e-08, usable: yes
//
// after a hundred revolutions the ellipse has turned by, and the planet is off by
// error of the state -0.11044 +- 0.00000   0.059
// turning          -0.00006 +- 0.00002   0.140
// chin4a           -0.22450 +- 0.00000   0.195
// pefrl            -0.59907 +- 0.00010   0.524
// verlet           -1.60405 +- 0.00078   1.644
