// SPDX-License-Identifier: BSL-1.0
#include "textbook_chain.hpp"

namespace nysalt::bench {

namespace {

void force(std::span<const double> q, std::span<double> f, double k) {
  const std::size_t n = q.size();
  double left = 4.0 * q[0] * q[0] * q[0];
  for (std::size_t i = 0; i + 2 < n; i += 2) {
    const double stiff = k * (q[i + 1] - q[i]);
    const double bond = q[i + 2] - q[i + 1];
    const double right = 4.0 * bond * bond * bond;
    f[i] = stiff - left;
    f[i + 1] = right - stiff;
    left = right;
  }
  const double stiff = k * (q[n - 1] - q[n - 2]);
  f[n - 2] = stiff - left;
  f[n - 1] = -4.0 * q[n - 1] * q[n - 1] * q[n - 1] - stiff;
}

}  // namespace

template <>
void textbook_chain<this_build>(std::span<double> q, std::span<double> p, std::span<double> f, double k,
                                double h, std::int64_t steps) {
  const std::size_t n = q.size();
  force(q, f, k);
  for (std::size_t i = 0; i < n; ++i) p[i] += 0.5 * h * f[i];
  for (std::int64_t step = 1; step <= steps; ++step) {
    for (std::size_t i = 0; i < n; ++i) q[i] += h * p[i];
    force(q, f, k);
    const double c = step < steps ? h : 0.5 * h;
    for (std::size_t i = 0; i < n; ++i) p[i] += c * f[i];
  }
}

template <>
void stream<this_build>(std::span<double> q, std::span<double> p, double c, std::int64_t steps) {
  double* const __restrict there = q.data();
  double* const __restrict back = p.data();
  for (std::int64_t step = 0; step < steps; ++step) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double x = there[i];
      there[i] = c * back[i];
      back[i] = c * x;
    }
  }
}

}  // namespace nysalt::bench
