// SPDX-License-Identifier: BSL-1.0
// A word with its coefficients and step, prepared for a system; half steps of letters O where one ends a step
// and another begins the next are one.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "nysalt/detail/known_letters.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/noise.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// How far a run is in its noise while it is stepped, room for the numbers of one letter O, and for what
/// other letters need.
template <NoiseSource Noise, Scalar T, int N, class Room>
struct noise_cursor {
  static constexpr bool is_noisy = true;  ///< there are letters O
  const Noise* source;                    ///< where numbers come from
  std::uint64_t trajectory;               ///< whose noise it is; that of lane 0
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

// A word with its coefficients and the step folded in, letters known at compile time.

/// What letters are prepared with, beside coefficients and step: where their word needs it, else nothing.
struct surroundings_of_word {
  std::optional<bath> heat_bath;  ///< for letters O; a copy, as a system may return it by value
  std::shared_ptr<const modal_coordinates> part;  ///< for letters R
  int threads = 1;                                ///< that may share a step
};

namespace detail {
/// One letter with its coefficients, from c[0] on, and the step folded in.
template <Flow Letter, int N, Scalar C>
auto prepare_letter(const C* c, double h, const surroundings_of_word& around) {
  if constexpr (StochasticFlow<Letter>) {
    return Letter::prepare(c[0], h, *around.heat_bath);
  } else if constexpr (QuadraticFlow<Letter>) {
    return Letter::template prepare<N>(c[0], h, around.part);
  } else {
    return prepare_coefficients<Letter>(c, h);
  }
}
}  // namespace detail

// clang-format off
/// Letters with coefficients and step folded in, and what a stepper does with them:
/// open(system, x)                from a synchronous state to an open one: force and first letter where needed
/// advance(system, x, n, cursor)  n steps of an open run; last letter of a step and first of the next are one
/// close(system, x, cursor)       an open state becomes synchronous
/// step(system, x, cursor)        one plain step, letter by letter, from only q and p
/// in_loop()                      itself, as a loop should hold it
/// The cursor says where the run is in its noise, and goes on with it.
// clang-format on
///
/// An open run is ahead of the synchronous state by a first letter that merges with the last. Where both are
/// of the bath it is behind instead: the letter O that meets the next step's is still to come. N is the
/// dimension of the system.
template <class W, Scalar C, int N>
class prepared_word;

/// Of letters known at compile time: unrolled, nothing is decided while stepping.
template <Scalar C, int N, Flow... L>
class prepared_word<word<L...>, C, N> {
  using W = word<L...>;

 public:
  /// One for each slot.
  using coefficients = typename W::template coefficients<C>;
  /// The cursor of the word holds a flow_room: there is a letter D, G, R or H.
  static constexpr bool needs_room = W::force_derivatives + W::displaced_forces > 0 ||
                                     (QuadraticFlow<L> || ...);

  /// Folds step and surroundings into the coefficients.
  prepared_word(const W&, const coefficients& c, double h, const surroundings_of_word& around)
      : letters_(prepare(c, h, around, std::make_index_sequence<W::length>{})) {
    if constexpr (W::merges) {
      std::array<C, first::slots> both;
      std::array<C, first::slots> back;
      for (std::size_t k = 0; k < first::slots; ++k) {
        both[k] = c[W::slots - first::slots + k] + c[k];
        back[k] = -c[k];
      }
      merged_ = detail::prepare_letter<first, N>(both.data(), h, around);
      undo_ = detail::prepare_letter<first, N>(back.data(), h, around);
    } else if constexpr (W::merges_half_steps) {
      merged_ = merged_half_steps<C>(std::get<W::length - 1>(letters_), std::get<0>(letters_),
                                     around.heat_bath->sigma() > 0.0);
    }
  }

  /// A copy: local coefficients cannot alias the system, so they stay in registers.
  prepared_word in_loop() const { return *this; }

  /// Opens a run. Cost: W::evaluations_to_open.
  template <class T, System S>
  void open(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::plan.is_known_when_open) force_of<W::reads, T>(system, x.q, x.f);
    if constexpr (W::merges) first::apply(system, std::get<0>(letters_), x, cursor.room);
  }
  /// Steps of an open run. Cost: W::evaluations_per_step each.
  template <class T, System S>
  [[gnu::always_inline]] void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t steps,
                                      auto& cursor) const {
    constexpr bool last_differs = W::plan.in_last != W::plan.in_loop;
    const std::int64_t alike = last_differs ? steps - 1 : steps;
    if constexpr (is_in_pairs && !is_dual<T>) {
      constexpr auto begins = std::same_as<typename W::template letter<W::first_in_loop>, kick>
                                  ? detail::pair_begins::with_kick
                                  : detail::pair_begins::with_drift;
      const auto pairs = pairs_of_loop(std::make_index_sequence<(end - W::first_in_loop) / 2>{});
      detail::take_pairs<begins, detail::last_force::unknown, T>(system, x, cursor.room, pairs.data(),
                                                                 pairs.size(), alike);
    } else {
      for (std::int64_t n = 0; n < alike; ++n) {
        loop<in_loop_plan, W::first_in_loop>(system, x, cursor);
        cursor.next();
      }
    }
    if constexpr (last_differs) {
      if (steps > 0) {
        loop<in_last_plan, W::first_in_loop>(system, x, cursor);
        cursor.next();
      }
    }
  }
  /// What an open state is at its step. No evaluation.
  template <class T, System S>
  void close(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::merges) first::apply(system, undo_, x, cursor.room);
    if constexpr (W::merges_half_steps) merged_.end(system, cursor, x);
  }
  /// One step from only q and p. Cost: W::evaluations_of_plain_step.
  template <class T, System S>
  void step(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::merges_half_steps) merged_.begin(system, cursor, x);
    plain<W::merges_half_steps ? 1 : 0>(system, x, cursor);
    cursor.next();
    if constexpr (W::merges_half_steps) merged_.end(system, cursor, x);
  }

 private:
  using first = typename W::template letter<0>;
  static constexpr std::size_t end =
      W::merges_half_steps ? W::length - 1 : W::length;  // of loop and plain step

  /// Whether a step of an open run is drifts and kicks in turn, several of each, whose forces nothing else
  /// needs.
  static constexpr bool is_in_pairs = [] {
    constexpr std::size_t first = W::first_in_loop;
    if (!std::same_as<C, double> || end - first < 4 || (end - first) % 2 != 0) return false;
    constexpr std::array is_kick{std::same_as<L, kick>...};
    constexpr std::array is_drift{std::same_as<L, drift>...};
    for (std::size_t i = first; i < end; ++i) {
      if (!is_kick[i] && !is_drift[i]) return false;
      if (i > first && is_kick[i] == is_kick[i - 1]) return false;
      if (is_kick[i] && W::plan.in_loop[i] != evaluation::unshared) return false;
    }
    return true;
  }();

  template <std::size_t I>
  double folded() const {
    if constexpr (W::merges && I + 1 == W::length) {
      return merged_;
    } else {
      return std::get<I>(letters_);
    }
  }
  template <std::size_t... I>
  auto pairs_of_loop(std::index_sequence<I...>) const {
    constexpr std::size_t first = W::first_in_loop;
    return std::array{std::array{folded<first + 2 * I>(), folded<first + 2 * I + 1>()}...};
  }

  template <std::size_t... I>
  static auto prepare(const coefficients& c, double h, const surroundings_of_word& around,
                      std::index_sequence<I...>) {
    return std::tuple(
        detail::prepare_letter<typename W::template letter<I>, N>(&c[W::first_slot(I)], h, around)...);
  }

  template <std::size_t I, evaluation E, class T, System S>
  [[gnu::always_inline]] static void apply(const S& system, const auto& prepared,
                                           flow_state<T, S::dimension>& x, auto& cursor) {
    using letter = typename W::template letter<I>;
    if constexpr (StochasticFlow<letter>) {
      apply_noise(system, prepared, W::stochastic_number(I), cursor, x);
    } else if constexpr (E == evaluation::unshared &&
                         requires { letter::evaluate_and_apply(system, prepared, x, cursor.room); }) {
      letter::evaluate_and_apply(system, prepared, x, cursor.room);
    } else {
      if constexpr (E != evaluation::none) force_of<W::reads, T>(system, x.q, x.f);
      letter::apply(system, prepared, x, cursor.room);
    }
  }

  // Types, not arrays: g++ 12 confuses template parameters that are arrays of equal length.
  struct in_loop_plan {
    static constexpr auto evaluations = W::plan.in_loop;
  };
  struct in_last_plan {
    static constexpr auto evaluations = W::plan.in_last;
  };

  template <class Plan, std::size_t I, class T, System S>
  [[gnu::always_inline]] void loop(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    constexpr evaluation evaluates = Plan::evaluations[I];
    if constexpr (W::merges_half_steps && I == 0) {
      merged_.cross(system, cursor, x);
    } else if constexpr (W::merges && I + 1 == W::length) {
      apply<I, evaluates>(system, merged_, x, cursor);
    } else {
      apply<I, evaluates>(system, std::get<I>(letters_), x, cursor);
    }
    if constexpr (I + 1 < end) loop<Plan, I + 1>(system, x, cursor);
  }

  template <std::size_t I, class T, System S>
  [[gnu::always_inline]] void plain(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    constexpr evaluation evaluates = W::plan.in_step[I];
    apply<I, evaluates>(system, std::get<I>(letters_), x, cursor);
    if constexpr (I + 1 < end) plain<I + 1>(system, x, cursor);
  }

  using letters_type = decltype(prepare({}, 1.0, {}, std::make_index_sequence<W::length>{}));
  using first_type = std::tuple_element_t<0, letters_type>;

  letters_type letters_;
  std::conditional_t<W::merges_half_steps, merged_half_steps<C>, first_type>
      merged_{};       // last and first letter in one
  first_type undo_{};  // the first letter taken back
};

}  // namespace nysalt
