// SPDX-License-Identifier: BSL-1.0
// A chain of wells in any units, anywhere: the same motion but for them, as a black box and over any scalar.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "draws.hpp"
#include "nysalt/system.hpp"

namespace nysalt::test {

/// Unit of length, and of the coordinates with odd numbers by how much more; of time and mass; and where the
/// wells are, in their lengths.
struct units {
  double length = 1.0;
  double mixed = 1.0;
  double time = 1.0;
  double mass = 1.0;
  double offset = 0.0;
};

/// V = E (sum_i (1 - cos x_i) + sum_i (x_{i+1} - x_i)^4/4) with x_i = q_i/L_i - offset, and E, m_i such that
/// each well alone has the frequency 1/time.
template <int N>
struct wells_in_units {
  static constexpr int dimension = N;
  units scales{};
  double first_factor = 1.0;  // of the first coordinate's force: not 1 is a mistake
  double bond_factor = 1.0;   // of the bonds' forces

  double length(Eigen::Index i) const { return i % 2 == 1 ? scales.length * scales.mixed : scales.length; }
  double mass(Eigen::Index i) const { return energy() * scales.time * scales.time / (length(i) * length(i)); }
  double energy() const { return scales.mass * scales.length * scales.length / (scales.time * scales.time); }
  double inverse_mass(Eigen::Index i) const { return 1.0 / mass(i); }

  template <class T>
  vector<T, N> places(const vector<T, N>& q) const {
    vector<T, N> x;
    for (Eigen::Index i = 0; i < N; ++i) x[i] = (q[i] - scales.offset * length(i)) * (1.0 / length(i));
    return x;
  }
  double potential(const vector<double, N>& q) const {
    const vector<double, N> x = places(q);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < N; ++i) sum += 1.0 - std::cos(x[i]);
    for (Eigen::Index i = 0; i + 1 < N; ++i) sum += 0.25 * std::pow(x[i + 1] - x[i], 4);
    return sum * energy();
  }
  template <class T>
  void force_over(const vector<T, N>& q, vector<T, N>& f) const {
    using std::sin;
    const vector<T, N> x = places(q);
    for (Eigen::Index i = 0; i < N; ++i) f[i] = sin(x[i]) * -1.0;
    for (Eigen::Index i = 0; i + 1 < N; ++i) {
      const T d = x[i + 1] - x[i];
      const T pull = d * d * d * bond_factor;
      f[i] += pull;
      f[i + 1] -= pull;
    }
    for (Eigen::Index i = 0; i < N; ++i) f[i] = f[i] * (energy() / length(i));
    f[0] = f[0] * first_factor;
  }
  std::string description() const { return "wells in units of " + std::to_string(scales.length); }
};

template <int N>
struct boxed_wells : wells_in_units<N> {
  void force(const vector<double, N>& q, vector<double, N>& f) const { this->force_over(q, f); }
};
template <int N>
struct open_wells : wells_in_units<N> {
  template <class T>
  void force(const vector<T, N>& q, vector<T, N>& f) const {
    this->force_over(q, f);
  }
};
static_assert(BlackBoxForce<boxed_wells<2>> && !BlackBoxForce<open_wells<2>>);

/// Some 1 from the bottom of each well, and as fast as that.
template <int N>
class starts_in_units {
 public:
  explicit starts_in_units(const wells_in_units<N>& wells) : wells_(wells) {}
  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    std::mt19937_64 bits{seed * 1000 + n};
    const auto number = [&] { return static_cast<double>(bits() >> 11U) * 0x1p-52 - 1.0; };
    phase_point<double, N> x;
    for (Eigen::Index i = 0; i < N; ++i) {
      x.q[i] = wells_.length(i) * (wells_.scales.offset + number());
      x.p[i] = wells_.mass(i) * wells_.length(i) / wells_.scales.time * number();
    }
    return x;
  }
  std::string description() const { return "starts in units"; }

 private:
  wells_in_units<N> wells_;
};

/// Lengths from 1e-10 to 1e10, near the origin and far from it, mixed, and in SI units of atoms.
inline std::vector<units> some_units() {
  std::vector<units> all;
  for (const double length : {1e-10, 1e-6, 1e-3, 1.0, 1e5, 1e10}) {
    for (const double offset : {0.0, 3.0, 100.0}) all.push_back({.length = length, .offset = offset});
  }
  all.push_back({.length = 1e-10, .time = 1e-15, .mass = 1e-26});
  all.push_back({.length = 1e-10, .time = 1e-15, .mass = 1e-26, .offset = -20.0});
  all.push_back({.length = 1e-10, .mixed = 1e20});
  all.push_back({.length = 1e5, .mixed = 1e-9, .time = 3e7, .offset = 1.0});
  return all;
}

}  // namespace nysalt::test
