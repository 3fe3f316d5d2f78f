// expect: nysalt: a letter of one's own in a word as data evaluates what it needs itself: reads = field::none
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/run_time_word.hpp"
#include "nysalt/systems/pendulum.hpp"

struct own_kick : nysalt::exact_flow<'b'> {
#ifndef NYSALT_CONTROL
  // [mistake]
  static constexpr nysalt::field reads = nysalt::field::whole;
  // [/mistake]
#endif
  static void apply(const auto&, const auto&, auto&, auto&) {}
};

int main() { nysalt::run_time_word(nysalt::word<nysalt::drift, own_kick>{}, nysalt::pendulum{}); }
