// expect: nysalt: a word as data carries letters of one's own for systems that are templates over the
//   scalar; step the word by its type
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/run_time_word.hpp"

struct own_drift : nysalt::exact_flow<'a'> {
  static void apply(const auto&, const auto&, auto&, auto&) {}
};

struct spring {
  static constexpr int dimension = 1;
#ifdef NYSALT_CONTROL
  template <class T>
  void force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const {
    f[0] = -q[0];
  }
#else
  // [mistake]
  void force(const nysalt::vector<double, 1>& q, nysalt::vector<double, 1>& f) const { f[0] = -q[0]; }
  // [/mistake]
#endif
};

int main() { nysalt::run_time_word(nysalt::word<own_drift, nysalt::kick>{}, spring{}); }
