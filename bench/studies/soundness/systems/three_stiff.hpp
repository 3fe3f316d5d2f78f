// SPDX-License-Identifier: BSL-1.0
// The FPU chain with springs of three stiff frequencies at once.
#include <nysalt/plugin.hpp>

#include <array>
#include <cmath>
#include <string>

/// Six unit masses between two walls: stiff springs of the frequencies slow, middle and fast, and quartic
/// ones before, between and behind them, as in nysalt::fpu_chain.
struct three_stiff {
  static constexpr int dimension = 6;
  double slow = 30.0;
  double middle = 50.0;
  double fast = 70.0;

  std::array<double, 3> frequencies() const { return {slow, middle, fast}; }

  template <class T>
  T potential(const nysalt::vector<T, dimension>& q) const {
    T sum(0.0);
    T bond = q[0];
    for (int i = 0; i < 3; ++i) {
      const T elongation = q[2 * i + 1] - q[2 * i];
      const double omega = frequencies()[static_cast<std::size_t>(i)];
      const T square = bond * bond;
      sum = sum + square * square + elongation * elongation * (0.25 * omega * omega);
      bond = i < 2 ? T(q[2 * i + 2] - q[2 * i + 1]) : T(-q[2 * i + 1]);
    }
    const T square = bond * bond;
    return sum + square * square;
  }

  template <class T>
  void force(const nysalt::vector<T, dimension>& q, nysalt::vector<T, dimension>& f) const {
    T left = pull(q[0]);
    for (int i = 0; i < 3; ++i) {
      const double omega = frequencies()[static_cast<std::size_t>(i)];
      const T stiff = (q[2 * i + 1] - q[2 * i]) * (0.5 * omega * omega);
      const T right = pull(i < 2 ? T(q[2 * i + 2] - q[2 * i + 1]) : T(-q[2 * i + 1]));
      f[2 * i] = stiff - left;
      f[2 * i + 1] = right - stiff;
      left = right;
    }
  }

  /// What a quartic spring stretched by u pulls with.
  template <class T>
  static T pull(const T& u) {
    return u * u * (u * 4.0);
  }
};

/// As nysalt::fpu_law with the spread 1: x_0 = y_0 = 1, x_1 = (1 + normal)/omega, y_1 = 1 + normal/omega.
struct three_stiff_law {
  three_stiff system;
  double spread;

  nysalt::phase_point<double, 6> operator()(std::uint64_t seed, std::uint64_t n) const {
    const nysalt::vector<double, 6> rest = nysalt::vector<double, 6>::Zero();
    nysalt::phase_point<double, 6> start = nysalt::normal_around<6>({rest, rest}, 1.0, 1.0)(seed, n);
    const double half = std::sqrt(0.5);
    for (int i = 0; i < 3; ++i) {
      const double omega = system.frequencies()[static_cast<std::size_t>(i)];
      const double x1 = (1.0 + spread * start.q[2 * i]) / omega;
      const double y1 = 1.0 + spread * start.p[2 * i] / omega;
      start.q[2 * i] = (1.0 - x1) * half;
      start.q[2 * i + 1] = (1.0 + x1) * half;
      start.p[2 * i] = (1.0 - y1) * half;
      start.p[2 * i + 1] = (1.0 + y1) * half;
    }
    return start;
  }
  std::string description() const { return "three_stiff_law(" + std::to_string(spread) + ")"; }
};

NYSALT_SYSTEM(three_stiff, "FPU chain with three stiff frequencies",
              parameter("slow", &three_stiff::slow, "frequency of the first stiff spring").positive(),
              parameter("middle", &three_stiff::middle, "frequency of the second").positive(),
              parameter("fast", &three_stiff::fast, "frequency of the third").positive(),
              starts([](const three_stiff& system, double spread) {
                return three_stiff_law{system, spread};
              }),
              observable("first_bond", [](const three_stiff&, const auto& x) { return x.q[0]; }));
