// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/linear_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/scalars/polynomial.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/stepping/served_letters.hpp"

namespace nysalt {

bool is_stable(const std::vector<stability_window>& windows, double low, double high) {
  return std::any_of(windows.begin(), windows.end(),
                     [&](const auto& window) { return window.low <= low && high <= window.high; });
}

std::vector<stability_window> detail::gaps_below(const std::vector<stability_window>& windows,
                                                 double highest) {
  std::vector<stability_window> gaps;
  double last = 0.0;
  for (const auto& window : windows) {
    const double next = std::min(window.low, highest);
    if (last < next) gaps.push_back({last, next});
    last = window.high;
  }
  if (last < highest) gaps.push_back({last, highest});
  return gaps;
}

double stability_margin(const std::vector<stability_window>& windows, double low, double high) {
  double end = 0.0;
  double margin_below = 1.0;
  for (const auto& window : windows) {
    if (!(window.low <= low)) break;
    end = window.high;
    margin_below = window.low > 0.0 ? 1.0 - window.low / low : 1.0;
  }
  if (!(end > 0.0)) return -std::numeric_limits<double>::infinity();
  return std::min(1.0 - high / end, margin_below);
}

std::vector<step_range> stable_steps(const std::vector<stability_window>& windows,
                                     const std::vector<frequency_band>& bands) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<step_range> result{{0.0, infinity}};
  for (const auto& band : bands) {
    if (!(band.high > 0.0)) continue;
    std::vector<step_range> both;
    for (const auto& window : windows) {
      if (band.low == 0.0 && window.low > 0.0) continue;
      const double low = band.low > 0.0 ? window.low / band.low : 0.0;
      const double high = window.high / band.high;
      for (const auto& range : result) {
        const step_range common{std::max(low, range.low), std::min(high, range.high)};
        if (common.low < common.high) both.push_back(common);
      }
    }
    result = both;
  }
  return result;
}

namespace {

using detail::dense_polynomial;

constexpr int most_evaluations = 64;

/// The system q'' = -q, which says what letters the oscillator serves.
struct oscillator {
  static constexpr int dimension = 1;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = -q[0];
  }
};

/// trace/2 of a word on the oscillator as a function of x = z^2.
class trace_of_word {
 public:
  trace_of_word(const nysalt::word& word, const std::vector<double>& c) : word_(word), c_(c) {
    const auto sum_of = [&](const std::vector<double>& coefficients, double sign) {
      const auto times = [&](const dense_polynomial& a) { return sign * a.times_x(); };
      return detail::oscillator_matrix<dense_polynomial>(word, coefficients, 0.0, {{0.0}}, {{1.0}}, times)
          .half_trace();
    };
    auto magnitudes = c;
    for (double& x : magnitudes) x = std::abs(x);
    polynomial_ = sum_of(c, 1.0);
    magnitude_ = sum_of(magnitudes, -1.0);  // no term cancels another
  }

  /// The coefficients of the derivative, those that are rounding set to zero, up to the last that is not.
  std::vector<double> slope() const {
    std::vector<double> result;
    std::size_t terms = 0;
    const auto& c = polynomial_.coefficient;
    for (std::size_t k = 1; k < c.size(); ++k) {
      const bool vanishes = std::abs(c[k]) <= rounding() * magnitude_.coefficient[k];
      result.push_back(vanishes ? 0.0 : static_cast<double>(k) * c[k]);
      if (!vanishes) terms = k;
    }
    result.resize(terms);
    return result;
  }

  detail::oscillator_matrix<double> matrix(double x) const {
    return detail::matrix_on_oscillator(word_, c_, x);
  }
  double operator()(double x) const { return matrix(x).half_trace(); }
  bool rises_at(double x) const {
    using D = dual<double, 1>;
    const D variable = D::variable(x, 0);
    const detail::oscillator_matrix<D> m(word_, c_, 0.0, D(0.0), D(1.0),
                                         [&](const D& y) { return variable * y; });
    return m.half_trace().derivative[0] > 0.0;
  }
  /// Values and derivatives at x: the k-th coefficient is the k-th derivative over k!.
  series<3> expansion_at(double x) const {
    using T = series<3>;
    T moving(x);
    moving += T::variable();
    return detail::oscillator_matrix<T>(word_, c_, 0.0, T(0.0), T(1.0),
                                        [&](const T& y) { return moving * y; })
        .half_trace();
  }
  detail::bernstein_polynomial on(double low, double high) const {
    return detail::half_trace(word_, c_, 0.0, low, high);
  }

  /// Relative, of sums without cancellation: each letter rounds twice, and is passed by two columns and both
  /// of its operands.
  double rounding() const {
    return 8.0 * static_cast<double>(word_.slots) * std::numeric_limits<double>::epsilon();
  }
  /// Within this of +-1 an extremum at x touches it: a bound of the rounding, which of long words is far too
  /// large, or what a table of ten digits leaves open.
  double tolerance(double x) const { return std::min(rounding() * magnitude_.tail(0, x), 1e-10); }

 private:
  const nysalt::word& word_;
  const std::vector<double>& c_;
  dense_polynomial polynomial_;
  dense_polynomial magnitude_;
};

/// Where a condition that holds at a and not at b, or the other way about, ends: the last number before.
double bisect(const auto& holds, double a, double b) {
  const bool at_a = holds(a);
  for (double m = std::midpoint(a, b); m != a && m != b; m = std::midpoint(a, b)) {
    (holds(m) == at_a ? a : b) = m;
  }
  return a;
}

/// Of a root x of trace/2 = y that may be threefold, as where methods of order four end, and is then known to
/// the third root of rounding only: the inflection beside it, a simple root of the second derivative, if
/// values and slope there are those of a threefold root; else x.
double sharpened(const trace_of_word& trace, double x, double y) {
  double inflection = x;
  for (int i = 0; i < 3; ++i) {  // Newton's method from 1e-5 beside: 1e-10, 1e-20
    const auto c = trace.expansion_at(inflection).coefficient;
    inflection -= c[2] / (3.0 * c[3]);
  }
  const double rounding = trace.tolerance(inflection);
  const auto [value, slope, bend, twist] = trace.expansion_at(inflection).coefficient;
  const bool is_threefold = std::abs(value - y) <= rounding && std::abs(slope) * inflection <= rounding;
  return is_threefold ? inflection : x;
}

/// Beyond this no root of sum_k c[k] x^k lies: 2 max |c_{n-k}/c_n|^{1/k} [fujiwara_1916].
double root_bound(const std::vector<double>& c) {
  const std::size_t n = c.size() - 1;
  double bound = 0.0;
  for (std::size_t k = 1; k <= n; ++k) {
    bound = std::max(bound, std::pow(std::abs(c[n - k] / c[n]), 1.0 / static_cast<double>(k)));
  }
  return 2.0 * bound;
}

/// An end of pieces on each of which trace/2 is monotone, or outside of -2..2.
struct piece_end {
  double x;
  bool is_extremum;
};

/// The ends of the pieces of 0..last, both among them. An interval with at most one change of sign among the
/// differences of its Bernstein coefficients has an extremum where the slopes at its ends differ in sign, and
/// no other; with more it is halved. The coefficients are found anew on each half: halves of coefficients
/// would keep the rounding of the whole interval, where the polynomial may be 1e15 times as large.
std::vector<piece_end> pieces_of(const trace_of_word& trace, std::size_t degree, double last) {
  struct interval {
    double low, high;
    bool rises_at_low, rises_at_high;
  };
  std::vector<piece_end> ends{{0.0, false}, {last, false}};
  std::vector<interval> level{{0.0, last, trace.rises_at(0.0), trace.rises_at(last)}};
  while (!level.empty()) {
    std::vector<interval> several;  // extrema, perhaps
    const auto settle = [&](const interval& one) {
      if (one.rises_at_low == one.rises_at_high) return;
      ends.push_back({bisect([&](double x) { return trace.rises_at(x); }, one.low, one.high), true});
    };
    for (const auto& one : level) {
      const auto f = trace.on(one.low, one.high);
      const auto [least, most] = f.bounds();
      if (least > 2.0 || most < -2.0) {
        ends.push_back({one.low, false});
        ends.push_back({one.high, false});
        continue;
      }
      // Closer than sqrt(eps) of x, extrema differ in value by less than rounding.
      const bool is_small = one.high - one.low <= 0x1p-26 * one.high;
      // One turn and equal slopes: an extremum so near to an end that rounding hides its side.
      const int most_turns = one.rises_at_low == one.rises_at_high ? 0 : 1;
      if (f.turns(trace.rounding()) > most_turns && !is_small) {
        several.push_back(one);
      } else {
        settle(one);
      }
    }
    level.clear();
    // A polynomial turns less often than its degree: more intervals than that show rounding.
    if (several.size() > degree) {
      for (const auto& one : several) settle(one);
      break;
    }
    for (const auto& one : several) {
      const double middle = std::midpoint(one.low, one.high);
      const bool rises = trace.rises_at(middle);
      level.push_back({one.low, middle, one.rises_at_low, rises});
      level.push_back({middle, one.high, rises, one.rises_at_high});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  // A double root of the slope may seem to be two. In 1e-6 of x, values between two extrema change by its
  // cube.
  for (std::size_t i = 0; i + 1 < ends.size();) {
    const bool is_pair = ends[i].is_extremum && ends[i + 1].is_extremum;
    if (is_pair && ends[i + 1].x - ends[i].x <= 1e-6 * ends[i].x) {
      ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(i),
                 ends.begin() + static_cast<std::ptrdiff_t>(i) + 2);
    } else {
      ++i;
    }
  }
  return ends;
}

}  // namespace

stability_chart chart_stability(const nysalt::word& word, const std::vector<double>& coefficients) {
  if (word.reads_modes) {
    throw std::invalid_argument(
        fmt::format("stability: the word must have no letters R, S or H, got {}, which is exact on the "
                    "oscillator at any step and which only its soft part can make unstable",
                    word.letters()));
  }
  if (word.evaluations_of_plain_step > most_evaluations) {
    throw std::invalid_argument(fmt::format("stability: evaluations of the word must be <= {}, got {}",
                                            most_evaluations, word.evaluations_of_plain_step));
  }
  require_served<oscillator, double>(word, oscillator{});
  word.require_one_for_each_slot(coefficients);
  const trace_of_word half_trace(word, coefficients);
  const auto slope = half_trace.slope();
  if (slope.empty()) return {};  // no letter moves the oscillator

  // Beyond its last extremum trace/2 leaves [-1, 1] for good.
  double last = 2.0 * std::max(1.0, root_bound(slope));
  while (std::abs(half_trace(last)) < 2.0) last *= 2.0;
  const auto pieces = pieces_of(half_trace, slope.size(), last);

  std::vector<double> edges{0.0};
  double at_a = 1.0;
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    const double a = pieces[i].x;
    const double b = pieces[i + 1].x;
    double at_b = half_trace(b);
    if (pieces[i + 1].is_extremum && std::abs(std::abs(at_b) - 1.0) <= half_trace.tolerance(b)) {
      at_b = std::copysign(1.0, at_b);
      edges.push_back(b);
    }
    const auto [least, most] = std::minmax({at_a, at_b});
    for (const double y : {-1.0, 1.0}) {
      if (!(least < y && y < most)) continue;
      edges.push_back(sharpened(half_trace, bisect([&](double x) { return half_trace(x) < y; }, a, b), y));
    }
    at_a = at_b;
  }
  std::sort(edges.begin(), edges.end());

  stability_chart chart;
  auto& windows = chart.windows;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double low = edges[i];
    const double high = edges[i + 1];
    if (!(std::abs(half_trace(std::midpoint(low, high))) < 1.0)) continue;
    const auto m = half_trace.matrix(low);
    const double z = std::sqrt(low);
    // Where the trace is known to e, what is off the diagonal of +-I errs by sqrt(2 e).
    const bool identity =
        std::max(std::abs(m.qp) * z, std::abs(m.pq) / z) < std::sqrt(2.0 * half_trace.tolerance(low));
    const bool adjoins = !windows.empty() && windows.back().high == low;
    if (adjoins && identity) {
      windows.back().high = high;
      chart.touching.push_back(z);
    } else {
      windows.push_back({low, high});
    }
  }
  for (auto& window : windows) window = {std::sqrt(window.low), std::sqrt(window.high)};
  return chart;
}

std::vector<stability_window> stability_windows(const nysalt::word& word,
                                                const std::vector<double>& coefficients) {
  return chart_stability(word, coefficients).windows;
}

}  // namespace nysalt
