// expect: nysalt: a letter of one's own takes a character that no known letter has
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/run_time_word.hpp"
#include "nysalt/systems/pendulum.hpp"

#ifdef NYSALT_CONTROL
constexpr char name = 'a';
#else
// [mistake]
constexpr char name = 'A';
// [/mistake]
#endif
struct own_drift : nysalt::exact_flow<name> {
  static void apply(const auto&, const auto&, auto&, auto&) {}
};

int main() { nysalt::run_time_word(nysalt::word<own_drift, nysalt::kick>{}, nysalt::pendulum{}); }
