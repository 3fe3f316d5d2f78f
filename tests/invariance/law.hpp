// SPDX-License-Identifier: BSL-1.0
// The law that a result depends neither on threads, lanes and ranks nor on where a run was cut.
#pragma once

#include <boost/test/unit_test.hpp>

#include <bit>
#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <ranges>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/ranks_as_threads.hpp"
#include "../support/systems.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/divergence.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/in_bath.hpp"

namespace nysalt::test {

/// How a computation is divided.
struct division {
  int threads = 1;
  bool in_lanes = true;  ///< false: one trajectory at a time
  bool is_cut = false;   ///< in two parts, the second of which goes on from what the first has kept
  const communicator* ranks = &one_rank;
};

/// The model of a system whose trajectories go in lanes, or one at a time; and in a bath.
template <System S>
model divided(const S& system, const division& how) {
  return how.in_lanes ? model(system) : model(in_lanes<S, 1>(system));
}
template <System S>
model divided(const S& system, const bath& heat, const division& how) {
  return how.in_lanes ? model(in_bath(system, heat)) : model(in_bath(in_lanes<S, 1>(system), heat));
}

inline const fpu_chain<3> chain(50.0);
inline const initial_states law = fpu_law<3>(chain);
/// They fill no number of lanes; three leaves, of which three ranks have one.
constexpr std::int64_t trajectories = 37;
inline model in_noise(const division& how) { return divided(chain, bath::of_sigma(0.5, 0.3), how); }

/// Numbers to the bit.
class numbers {
 public:
  numbers& operator<<(double x) {
    bits_.push_back(std::bit_cast<std::uint64_t>(x));
    return *this;
  }
  numbers& operator<<(std::integral auto x) { return *this << static_cast<double>(x); }
  template <class X>
  numbers& operator<<(const std::optional<X>& x) {
    *this << x.has_value();
    return x ? *this << *x : *this;
  }
  numbers& operator<<(const std::ranges::range auto& all) {
    for (const auto& x : all) *this << x;
    return *this;
  }
  numbers& operator<<(const estimate& x) { return *this << x.mean << x.standard_error; }
  numbers& operator<<(const diverged_trajectory& x) { return *this << x.trajectory << x.step; }
  template <class X>
    requires requires(const X& x) { x.q.size() + x.p.size(); }
  numbers& operator<<(const X& x) {
    return *this << x.q << x.p;
  }

  bool empty() const { return bits_.empty(); }
  friend bool operator==(const numbers&, const numbers&) = default;

 private:
  std::vector<std::uint64_t> bits_;
};

/// What a computation returns on one rank.
struct result {
  numbers of_all;                           ///< the same on all ranks
  std::map<std::int64_t, numbers> of_each;  ///< of trajectories, each of which is on one rank
  friend bool operator==(const result&, const result&) = default;
};

/// What a computation can be divided by.
enum divisible : unsigned { by_threads = 1, by_lanes = 2, by_ranks = 4, by_cuts = 8 };

struct computation {
  std::string name;
  unsigned divides;  ///< a sum of `divisible`
  std::function<result(const division&, std::uint64_t seed)> of;
};

/// The result on that many ranks, put together. Throws std::logic_error unless ranks agree on what is of all,
/// and each trajectory is on one rank.
inline result on_ranks(const computation& what, const division& how, std::uint64_t seed, int size) {
  if (size == 1) return what.of(how, seed);
  std::vector<result> found(static_cast<std::size_t>(size));
  run_ranks(size, [&](const communicator& ranks) {
    division ours = how;
    ours.ranks = &ranks;
    found[static_cast<std::size_t>(ranks.rank())] = what.of(ours, seed);
  });
  result whole = found.front();
  for (std::size_t r = 1; r < found.size(); ++r) {
    if (found[r].of_all != whole.of_all) throw std::logic_error("ranks do not agree");
    const std::size_t before = whole.of_each.size();
    whole.of_each.insert(found[r].of_each.begin(), found[r].of_each.end());
    if (whole.of_each.size() != before + found[r].of_each.size())
      throw std::logic_error("a trajectory is on two ranks");
  }
  return whole;
}

/// The divisions that change the result: none should.
inline std::vector<std::string> divisions_that_show(const computation& what) {
  const auto choices = [&](divisible by, std::vector<int> all) {
    return (what.divides & by) != 0U ? all : std::vector{all.front()};
  };
  const result expected = what.of({}, 1);
  std::vector<std::string> found;
  for (const int threads : choices(by_threads, {1, 2, 7})) {
    for (const int in_lanes : choices(by_lanes, {1, 0})) {
      for (const int is_cut : choices(by_cuts, {0, 1})) {
        for (const int ranks : choices(by_ranks, {1, 3})) {
          const division how{.threads = threads, .in_lanes = in_lanes == 1, .is_cut = is_cut == 1};
          const std::string name = std::to_string(threads) + " threads, " + std::to_string(ranks) + " ranks" +
                                   (how.in_lanes ? ", in lanes" : ", one by one") +
                                   (how.is_cut ? ", cut" : "");
          try {
            if (on_ranks(what, how, 1, ranks) != expected) found.push_back(name);
          } catch (const std::logic_error& problem) {
            found.push_back(name + ": " + problem.what());
          }
        }
      }
    }
  }
  return found;
}

/// The law, and that the result can show a difference: with another seed it is another one.
inline void require_invariance(const std::vector<computation>& all) {
  for (const computation& what : all) {
    BOOST_TEST_CONTEXT(what.name) {
      for (const auto& division : divisions_that_show(what)) BOOST_ERROR("it depends on: " << division);
      BOOST_TEST((what.of({}, 2) != what.of({}, 1)));
    }
  }
}

}  // namespace nysalt::test
