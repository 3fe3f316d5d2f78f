// expect: nysalt: an own loss returns its residuals over the T of its states, at least one: a `T`, a
//   `std::array<T, n>` or a `vector<T, n>`; of an expression, say `-> vector<T, n>`
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/losses/own_loss.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using nysalt::phase_point;
using nysalt::vector;

#ifdef NYSALT_CONTROL
auto place = []<class T>(const phase_point<T, 2>&, const phase_point<T, 2>& finish,
                         const phase_point<T, 2>& wanted) -> vector<T, 2> { return finish.q - wanted.q; };
#else
// [mistake]
auto place = [](const auto&, const auto& finish, const auto& wanted) { return finish.q - wanted.q; };
// [/mistake]
#endif

int main() { nysalt::own_error(nysalt::henon_heiles(), place); }
