// SPDX-License-Identifier: BSL-1.0
// A method's letters as data: for coefficients that come from a file.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// Every flow that a word can name by its letter at run time.
using known_letters = std::tuple<drift, kick>;

namespace detail {
/// f(flow) for the known flow of that letter; false if there is none.
[[gnu::always_inline]] inline bool with_letter(char letter, auto&& f) {
  return std::apply([&](auto... flow) { return ((flow.letter == letter && (f(flow), true)) || ...); },
                    known_letters{});
}
}  // namespace detail

/// What word<...> knows at compile time, found when it is made: which letters merge, where the force is at
/// hand, and how many evaluations that leaves.
class run_time_word {
 public:
  template <class C>
  using coefficients = std::vector<C>;

  /// Letters as in docs/notation.md, acting from left to right: "BAB" is velocity Verlet.
  /// Throws std::invalid_argument if there is none, or one that is not known.
  explicit run_time_word(std::string letters) : length(letters.size()), letters_(std::move(letters)) {
    if (letters_.empty()) throw std::invalid_argument("a word needs at least one letter");
    bool additive = false;
    for (std::size_t i = 0; i < length; ++i) {
      const bool is_known = detail::with_letter(letters_[i], [&](auto flow) {
        reads_.push_back(flow.reads_force);
        moves_.push_back(flow.moves_q);
        if (i == 0) additive = flow.additive;
      });
      if (!is_known) {
        throw std::invalid_argument(fmt::format("the word {} holds the letter {}; known letters are {}",
                                                letters_, letters_[i], all_known()));
      }
    }
    merges = length > 1 && letters_.front() == letters_.back() && additive;
    const std::size_t first = first_in_loop();
    known_in_step.resize(length);
    known_in_loop.resize(length);
    detail::track_force(reads_, moves_, known_in_step, 0, false);
    detail::track_force_in_loop(reads_, moves_, known_in_loop, first);
    evaluations_per_step = detail::count_evaluations(reads_, known_in_loop, first);
    evaluations_to_open = detail::count_evaluations_to_open(reads_, moves_, known_in_loop, first);
    evaluations_of_plain_step = detail::count_evaluations(reads_, known_in_step, 0);
  }
  template <TypeLevelWord W>
  explicit run_time_word(W) : run_time_word(W::letters()) {}

  const std::string& letters() const { return letters_; }
  std::size_t first_in_loop() const { return merges ? 1 : 0; }
  /// Letter i reads the force and does not find it known.
  bool evaluates_in_loop(std::size_t i) const { return reads_[i] && !known_in_loop[i]; }
  bool evaluates_in_step(std::size_t i) const { return reads_[i] && !known_in_step[i]; }

  std::size_t length;
  bool merges;
  std::vector<bool> known_in_step;
  std::vector<bool> known_in_loop;
  int evaluations_per_step;
  int evaluations_to_open;
  int evaluations_of_plain_step;

 private:
  static std::string all_known() {
    std::string all;
    std::apply([&](auto... flow) { ((all += all.empty() ? "" : ", ", all += flow.letter), ...); },
               known_letters{});
    return all;
  }

  std::string letters_;
  std::vector<bool> reads_;
  std::vector<bool> moves_;
};

/// What a stepper takes.
template <class W>
concept Word = TypeLevelWord<W> || std::same_as<W, run_time_word>;

}  // namespace nysalt
