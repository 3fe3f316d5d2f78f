// SPDX-License-Identifier: BSL-1.0
// The noise of a run while it is stepped; half steps of letters O where one ends a step and another begins
// the next are one.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/noise.hpp"

namespace nysalt {

namespace detail {

/// How far a run is in its noise while it is stepped, room for the numbers of one letter O, and for what
/// other letters need.
template <NoiseSource Noise, Scalar T, int N, class Room>
struct noise_cursor {
  static constexpr bool is_noisy = true;  ///< there are letters O
  const Noise* source;                    ///< where numbers come from
  std::uint64_t trajectory;               ///< whose noise it is; the trajectory of lane 0
  std::int64_t step;                      ///< that is under way
  int letters;                            ///< O of a word
  bool bath_is_warm;                      ///< false: sigma = 0, no number is drawn
  vector<T, N> xi;                        ///< of the last draw
  Room room;                              ///< for letters G, R, H, or none

  /// Standard normal numbers for letter O number `letter` of a step; held until the next draw.
  const vector<T, N>& draw(std::int64_t of_step, int letter) {
    source->normals({trajectory, of_step, letter}, xi);
    return xi;
  }
  void next() { ++step; }  ///< to the next step
};

/// The same where a word has no letter O.
template <class Room>
struct quiet_cursor {
  static constexpr bool is_noisy = false;  ///< no letter O
  Room room;                               ///< for letters G, R, H, or none
  void next() {}                           ///< no noise, nothing to count
};

/// One letter O of a step.
template <System S, Scalar T, Scalar C>
void apply_noise(const S& system, const ornstein_uhlenbeck::prepared<C>& flow, int letter, auto& cursor,
                 flow_state<T, S::dimension>& x) {
  if (!cursor.bath_is_warm) return ornstein_uhlenbeck::damp(system, flow.decay, x);
  ornstein_uhlenbeck::apply(system, flow, cursor.draw(cursor.step, letter), x);
}

/// Two letters O that meet between steps, one that ends a step (a_1, s_1) and one that begins the next
/// (a_2, s_2), take a single draw xi:
///   p <- a_2 a_1 p + s xi,  s^2 = a_2^2 s_1^2 + s_2^2.
/// The state between them, if it is observed, needs a further draw zeta, which changes nothing of what comes:
///   xi_1 = u xi + v zeta,  xi_2 = v xi - u zeta,  u = a_2 s_1/s,  v = s_2/s
/// are independent standard normal, and a_2 s_1 xi_1 + s_2 xi_2 = s xi. A path has its own xi_1 and xi_2, and
/// they are taken. Before the first step there is only xi_2.
template <Scalar C>
class merged_half_steps {
 public:
  merged_half_steps() = default;
  /// From the letters as they are prepared. `bath_is_warm`: sigma > 0, so that there is noise.
  merged_half_steps(const ornstein_uhlenbeck::prepared<C>& end, const ornstein_uhlenbeck::prepared<C>& begin,
                    bool bath_is_warm)
      : end_(end), begin_(begin) {
    using std::sqrt;
    both_.decay = begin.decay * end.decay;
    if (!bath_is_warm) return;
    const C of_end = begin.decay * end.deviation;
    both_.deviation = sqrt(of_end * of_end + begin.deviation * begin.deviation);
    if (!any(both_.deviation > C(0.0))) return;  // their coefficients are 0
    u_ = of_end / both_.deviation;
    v_ = begin.deviation / both_.deviation;
  }

  /// From the end of the last step into the one that begins.
  template <System S, Scalar T>
  void cross(const S& system, auto& cursor, flow_state<T, S::dimension>& x) const {
    if (cursor.step == 0) return begin(system, cursor, x);
    if (!cursor.bath_is_warm) return ornstein_uhlenbeck::damp(system, both_.decay, x);
    if constexpr (is_memoryless<decltype(*cursor.source)>) {
      ornstein_uhlenbeck::apply(system, both_, cursor.draw(cursor.step, 0), x);
    } else {
      end(system, cursor, x);
      begin(system, cursor, x);
    }
  }

  /// The letter that ends the step before the cursor's; before the first step there is none.
  template <System S, Scalar T>
  void end(const S& system, auto& cursor, flow_state<T, S::dimension>& x) const {
    if (cursor.step == 0) return;
    if (!cursor.bath_is_warm) return ornstein_uhlenbeck::damp(system, end_.decay, x);
    if constexpr (is_memoryless<decltype(*cursor.source)>) {
      ornstein_uhlenbeck::apply(system, end_, half(cursor, u_, v_), x);
    } else {
      ornstein_uhlenbeck::apply(system, end_, cursor.draw(cursor.step - 1, cursor.letters - 1), x);
    }
  }

  /// The letter that begins the cursor's step.
  template <System S, Scalar T>
  void begin(const S& system, auto& cursor, flow_state<T, S::dimension>& x) const {
    if (!cursor.bath_is_warm) return ornstein_uhlenbeck::damp(system, begin_.decay, x);
    if constexpr (is_memoryless<decltype(*cursor.source)>) {
      ornstein_uhlenbeck::apply(system, begin_, half(cursor, v_, -u_), x);
    } else {
      ornstein_uhlenbeck::apply(system, begin_, cursor.draw(cursor.step, 0), x);
    }
  }

 private:
  template <class Source>
  static constexpr bool is_memoryless = std::remove_reference_t<Source>::is_memoryless;

  /// of_xi xi + of_zeta zeta
  static const auto& half(auto& cursor, const C& of_xi, const C& of_zeta) {
    auto zeta = cursor.xi;
    cursor.draw(cursor.step, 0);
    cursor.source->halving({cursor.trajectory, cursor.step, 0}, zeta);
    for (Eigen::Index i = 0; i < zeta.size(); ++i) {
      cursor.xi[i] = cursor.xi[i] * of_xi + zeta[i] * of_zeta;
    }
    return cursor.xi;
  }

  ornstein_uhlenbeck::prepared<C> end_;
  ornstein_uhlenbeck::prepared<C> begin_;
  ornstein_uhlenbeck::prepared<C> both_;
  C u_{0.0};
  C v_{0.0};
};

}  // namespace detail

}  // namespace nysalt
